//! Axial effect laws of a rope: forces that effects of the catalogue add between its cylinders, on top of the
//! joints' forces.
//!
//! A law depends only on a joint's extension and its rate, not on whether the cylinders move in the plane or
//! in space.
use super::parts::{Chain, Joints};
use super::state::ChainState;
use super::unit_loads::UnitLoads;
use crate::element::bushing::{AxialTension, LinkLoad};
use crate::model::extension::{LineForceValue, MemoryDerivatives};

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Evaluates the axial effect laws of the rope at a joint between two cylinders; returns their force with
    /// the joint's extension \[m\] and its rate [m/s]; `None` for an end joint or a rope without such laws.
    #[inline]
    pub(super) fn axial_effect(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> Option<(LineForceValue, [f64; 2])> {
        joints.axial.filter(|_| joint > 0 && joint < self.count)?;
        let at = self.extension(joint, joints, state)?;
        Some((axial_force(joint, joints, state, at)?, at))
    }

    /// Returns the additional tension of the axial effect laws at a joint, with its derivatives and its
    /// dissipated power; `None` for an end joint or a rope without such laws.
    #[inline]
    pub(super) fn pull(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> Option<AxialTension> {
        let (along, [_, rate]) = self.axial_effect(joint, joints, state)?;
        Some(tension(along, rate))
    }

    /// Adds the forces of the axial effect laws on the cylinders to `force`, without the joints' own forces.
    pub(crate) fn add_pulls(&self, joints: &Joints<'_>, state: &ChainState, force: &mut [f64]) {
        for joint in 1..self.count {
            if self.in_plane(joint) {
                let at = self.plane_geometry(joint, state);
                let stretched = [at.deformation[0], at.rate[0]];
                let Some(pull) = pull_at(joint, joints, state, stretched) else {
                    return;
                };
                let load = at.load([pull.force, 0.0, 0.0]);
                let rows = force[(self.first + joint - 1) * 3..].iter_mut();
                for (force, own) in rows.zip(load.on_coordinates()) {
                    *force += own;
                }
            } else if let Some(([i, j], law)) = self.link(joint, joints, state) {
                let Some(pull) = pull_at(joint, joints, state, law.extension(&i, &j)) else {
                    return;
                };
                let mut load = LinkLoad::none();
                law.add_pull((&i, &j), &pull, &mut load);
                self.add_load(joint, &load, state, force);
            }
        }
    }

    /// Updates the memory of history-dependent axial laws at the end of a step.
    pub(crate) fn update_memory(&self, joints: &Joints<'_>, state: &mut ChainState) {
        let Some(laws) = joints.axial else { return };
        let first = state.memory.is_empty();
        let mut memory = std::mem::take(&mut state.memory);
        memory.resize((self.count + 1) * laws.len(), [0.0; 2]);
        let mut any = false;
        for (joint, memories) in memory.chunks_exact_mut(laws.len()).enumerate() {
            let inner = joint > 0 && joint < self.count;
            let at = inner
                .then(|| self.extension(joint, joints, state))
                .flatten();
            if let Some([extension, rate]) = at {
                any |= laws.remember(extension, rate, memories, first);
            }
        }
        if !any {
            memory.clear();
        }
        state.memory = memory;
    }

    /// Computes the derivatives that concern the memory of the rope's axial laws, for each joint between two cylinders
    /// and each law, for motion in the plane; `out` is empty where no law has memory.
    pub(crate) fn memory_derivatives(
        &self,
        joints: &Joints<'_>,
        (state, units): (&ChainState, &UnitLoads),
        out: &mut Vec<MemoryDerivatives>,
    ) {
        out.clear();
        let Some(laws) = joints.axial else { return };
        let mut any = false;
        for joint in 1..self.count {
            let memories = state.memory.chunks_exact(laws.len()).nth(joint);
            let each = laws.memory_derivatives(units.stretch(joint - 1), memories.unwrap_or(&[]));
            out.extend(each.map(|own| {
                any |= own.is_some();
                own.unwrap_or_default()
            }));
        }
        if !any {
            out.clear();
        }
    }

    /// Returns the extension \[m\] of a joint between two cylinders and its rate [m/s].
    fn extension(&self, joint: usize, joints: &Joints<'_>, state: &ChainState) -> Option<[f64; 2]> {
        if self.in_plane(joint) {
            let at = self.plane_geometry(joint, state);
            return Some([at.deformation[0], at.rate[0]]);
        }
        let ([i, j], law) = self.link(joint, joints, state)?;
        Some(law.extension(&i, &j))
    }
}

/// Returns the additional tension of the axial effect laws at a joint between two cylinders with the given
/// extension \[m\] and its rate [m/s]; `None` for a rope without such laws.
#[inline]
pub(super) fn pull_at(
    joint: usize,
    joints: &Joints<'_>,
    state: &ChainState,
    at: [f64; 2],
) -> Option<AxialTension> {
    Some(tension(axial_force(joint, joints, state, at)?, at[1]))
}

/// Evaluates the axial effect laws of the rope at a joint between two cylinders.
#[inline]
fn axial_force(
    joint: usize,
    joints: &Joints<'_>,
    state: &ChainState,
    [extension, rate]: [f64; 2],
) -> Option<LineForceValue> {
    let laws = joints.axial?;
    let memories = state.memory.chunks_exact(laws.len()).nth(joint);
    Some(laws.pull(extension, rate, memories.unwrap_or(&[])))
}

/// Returns the tension of axial effect laws at a rate of extension [m/s].
fn tension(along: LineForceValue, rate: f64) -> AxialTension {
    AxialTension {
        force: along.spring + along.non_conservative,
        dissipated: along.non_conservative * rate,
        by_extension: along.by_place,
        by_rate: along.by_rate,
    }
}
