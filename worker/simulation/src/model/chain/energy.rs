//! Potential energy of a chain.
use super::parts::{Chain, Joints};
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::element::law::ForceLaw;
use nalgebra::Vector3;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Returns the potential of the non-elastic forces of axial effect laws in a static state \[J\]: force
    /// times extension.
    pub(crate) fn non_elastic_potential(&self, joints: &Joints<'_>, state: &ChainState) -> f64 {
        let mut sum = 0.0;
        if joints.axial.is_none() {
            return sum;
        }
        for joint in 1..self.count {
            if let Some((along, [extension, _])) = self.axial_effect(joint, joints, state) {
                sum += along.non_conservative * extension;
            }
        }
        sum
    }

    /// Adds the elastic energy of joints and contact and the gravitational energy of the cylinders to `sum`
    /// \[J\]. The contact points must already be evaluated in `state`.
    pub(crate) fn add_potential(
        &self,
        sum: &mut f64,
        gravity: &Vector3<f64>,
        joints: &Joints<'_>,
        contact: Option<&Impact>,
        state: &ChainState,
    ) {
        for joint in 0..=self.count {
            if self.in_plane(joint) {
                let at = self.plane_joint(joint, state);
                *sum += joints.inner.response(at.deformation, at.rate).energy;
            } else if let Some(([i, j], law)) = self.link(joint, joints, state) {
                *sum += law.energy(&i, &j);
            }
            if let Some((along, _)) = self.axial_effect(joint, joints, state) {
                *sum += along.energy;
            }
        }
        if let Some(law) = contact {
            state.points.add_energy(sum, law);
        }
        let weight = gravity * self.mass;
        for pose in &state.poses {
            *sum -= weight.dot(&pose.p);
        }
        for pose in state.plane.iter() {
            *sum -= weight.xy().dot(&pose.p);
        }
    }
}
