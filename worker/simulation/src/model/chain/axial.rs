//! Axial effect laws of a rope: forces that effects of the catalogue add between its cylinders, on top of the
//! joints' forces.
//!
//! A law depends only on a joint's extension and its rate, not on whether the cylinders move in the plane or
//! in space.
use super::parts::{Chain, Joints};
use super::state::ChainState;
use super::unit_loads::UnitLoads;
use crate::element::bushing::{AxialTension, LinkLoad};
use crate::element::law::LawResponse;
use crate::element::plane::{DEFORMATIONS, PlaneJoint};
use crate::math::real::{Vector, WIDEST};
use crate::model::extension::axial::AxialLaws;
use crate::model::extension::{LineForceValue, Memory, MemoryDerivatives};
use pulp::Simd;

/// Axial effect laws of a rope, with the memory of its joints.
#[derive(Clone, Copy, Debug)]
pub(super) struct AxialEffects<'a> {
    laws: AxialLaws<'a>,
    memory: &'a [Memory],
}

impl<'a> AxialEffects<'a> {
    /// Returns the laws of a rope with the memory of its joints; `None` for a rope without laws.
    pub(super) fn new(joints: &Joints<'a>, memory: &'a [Memory]) -> Option<Self> {
        Some(Self {
            laws: joints.axial?,
            memory,
        })
    }

    /// Returns the summed force of the laws at a joint between two cylinders with the given extension \[m\] and its rate
    /// [m/s], with its derivatives and its energy.
    fn force(&self, joint: usize, [extension, rate]: [f64; 2]) -> LineForceValue {
        let first = joint * self.laws.len();
        let own = self.memory.get(first..first + self.laws.len());
        self.laws.pull(extension, rate, own.unwrap_or(&[]))
    }

    /// Returns the additional tension of the laws at a joint between two cylinders with the given extension \[m\] and
    /// its rate [m/s].
    fn tension(&self, joint: usize, at: [f64; 2]) -> AxialTension {
        let along = self.force(joint, at);
        AxialTension {
            force: along.spring + along.non_conservative,
            dissipated: along.non_conservative * at[1],
            by_extension: along.by_place,
            by_rate: along.by_rate,
        }
    }

    /// Adds the tension of the laws to the responses of the joints' own law, one joint per SIMD lane. Lane 0 is joint
    /// `first`; lanes beyond joint `last` are unchanged.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(super) fn add_to<S: Simd>(
        &self,
        simd: S,
        [first, last]: [usize; 2],
        at: &PlaneJoint<Vector<S>>,
        answer: &mut LawResponse<Vector<S>, DEFORMATIONS>,
    ) {
        let (extensions, rates) = (at.deformation[0].to_array(), at.rate[0].to_array());
        let mut further = [[0.0; WIDEST]; 4];
        for joint in first..=last.min(first + S::F64_LANES - 1) {
            let lane = joint - first;
            let tension = self.tension(joint, [extensions[lane], rates[lane]]);
            further[0][lane] = tension.force;
            further[1][lane] = tension.by_extension;
            further[2][lane] = tension.by_rate;
            further[3][lane] = tension.dissipated;
        }
        let [force, by_extension, by_rate, dissipated] = further
            .each_ref()
            .map(|lanes| Vector::from_array(simd, lanes));
        answer.force[0] = answer.force[0] + force;
        answer.stiffness[0][0] = answer.stiffness[0][0] + by_extension;
        answer.damping[0][0] = answer.damping[0][0] + by_rate;
        answer.dissipated = answer.dissipated + dissipated;
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Returns the axial effect laws of the rope, and extension \[m\] and its rate [m/s] of a joint between two
    /// cylinders; `None` for an end joint or a rope without such laws.
    #[inline]
    fn axial_at<'a>(
        &self,
        joint: usize,
        joints: &Joints<'a>,
        state: &'a ChainState,
    ) -> Option<(AxialEffects<'a>, [f64; 2])> {
        let laws = AxialEffects::new(joints, &state.memory);
        let laws = laws.filter(|_| joint > 0 && joint < self.count)?;
        Some((laws, self.extension(joint, joints, state)?))
    }

    /// Evaluates the axial effect laws of the rope at a joint between two cylinders; returns their force with
    /// the joint's extension \[m\] and its rate [m/s]; `None` for an end joint or a rope without such laws.
    pub(super) fn axial_effect(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> Option<(LineForceValue, [f64; 2])> {
        let (laws, at) = self.axial_at(joint, joints, state)?;
        Some((laws.force(joint, at), at))
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
        let (laws, at) = self.axial_at(joint, joints, state)?;
        Some(laws.tension(joint, at))
    }

    /// Adds the forces of the axial effect laws on the cylinders to `force`, without the joints' own forces. `memory` is
    /// that of these laws; empty for laws without memory and before the first step.
    pub(crate) fn add_pulls(
        &self,
        joints: &Joints<'_>,
        (state, memory): (&ChainState, &[Memory]),
        force: &mut [f64],
    ) {
        let Some(laws) = AxialEffects::new(joints, memory) else {
            return;
        };
        for joint in 1..self.count {
            if self.in_plane(joint) {
                let at = self.plane_joint(joint, state);
                let pull = laws.tension(joint, [at.deformation[0], at.rate[0]]);
                let load = at.load([pull.force, 0.0, 0.0]);
                let rows = force[(self.first + joint - 1) * 3..].iter_mut();
                for (force, own) in rows.zip(load.on_coordinates()) {
                    *force += own;
                }
            } else if let Some(([i, j], law)) = self.link(joint, joints, state) {
                let pull = laws.tension(joint, law.extension(&i, &j));
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
            let at = self.plane_joint(joint, state);
            return Some([at.deformation[0], at.rate[0]]);
        }
        let ([i, j], law) = self.link(joint, joints, state)?;
        Some(law.extension(&i, &j))
    }
}
