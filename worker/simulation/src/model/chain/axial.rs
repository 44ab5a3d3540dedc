//! Laws of effects along a rope: pulls between its cylinders beside the joints' own.
//!
//! A law knows extension and rate alone, not whether the cylinders move in the plane or in space.
use super::{Chain, ChainState, Joints};
use crate::effect::Along;
use crate::element::bushing::Pull;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// What laws along the rope say of a joint between two cylinders, and the extension \[m\] and its
    /// rate [m/s] at which they say it; nothing where there are none, or at an end.
    #[inline]
    pub(super) fn along(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> Option<(Along, [f64; 2])> {
        let laws = joints.axial.filter(|_| joint > 0 && joint < self.count)?;
        let at = self.extension(joint, joints, state)?;
        let [extension, rate] = at;
        let memory = state.memory.get(joint).copied();
        Some((laws.pull(extension, rate, memory), at))
    }

    /// What they pull there.
    #[inline]
    pub(super) fn pull(
        &self,
        joint: usize,
        joints: &Joints<'_>,
        state: &ChainState,
    ) -> Option<Pull> {
        let (along, [_, rate]) = self.along(joint, joints, state)?;
        Some(Pull {
            force: along.spring + along.other,
            dissipated: along.other * rate,
            by_extension: along.by_place,
            by_rate: along.by_rate,
        })
    }

    /// Lets laws with a past remember the step that ended in these poses.
    pub(crate) fn remember(&self, joints: &Joints<'_>, state: &mut ChainState) {
        let Some(laws) = joints.axial else { return };
        let first = state.memory.is_empty();
        state.memory.resize(self.count + 1, [0.0; 2]);
        for joint in 1..self.count {
            let Some([extension, rate]) = self.extension(joint, joints, state) else {
                continue;
            };
            let before = (!first).then(|| state.memory[joint]);
            let Some(memory) = laws.remember(extension, rate, before) else {
                state.memory.clear();
                return;
            };
            state.memory[joint] = memory;
        }
    }

    /// Extension \[m\] of a joint between two cylinders and its rate [m/s].
    fn extension(&self, joint: usize, joints: &Joints<'_>, state: &ChainState) -> Option<[f64; 2]> {
        if self.in_plane(joint) {
            let [i, j] = self.plane_markers(joint, &state.plane);
            return Some(joints.inner.plane_extension(&i, &j));
        }
        let ([i, j], law) = self.link(joint, joints, state)?;
        Some(law.extension(&i, &j))
    }
}
