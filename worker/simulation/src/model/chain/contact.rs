//! Contact forces between a chain (rope) and an arc, on the chain's cylinders and on the beam or head that
//! carries the arc.
use super::parts::Chain;
use super::points::{CylinderContact, Cylinders, Points};
use super::state::ChainState;
use crate::element::impact::Impact;
use crate::linear::BLOCK;
use crate::model::contact::Surface;
use crate::model::layout::MAX_MODES;
use crate::model::layout::Motion;
use crate::model::pose::{InPlane, Pose};

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Evaluates geometry and force law at the contact points for the cylinder poses in `state`.
    pub(crate) fn evaluate_contact(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        state: &mut ChainState,
    ) {
        let cylinders = match self.motion {
            Motion::Plane => Cylinders::Plane(&state.plane),
            Motion::Space => Cylinders::Space(&state.poses),
        };
        state.points.evaluate(self, surface, law, cylinders);
    }

    /// Evaluates the contact and adds its forces on the cylinders and on the `border` coordinates, which are
    /// the beam angle and the modes. An arc fixed in the world frame W has no border.
    pub(crate) fn add_contact(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        state: &mut ChainState,
        force: &mut [f64],
        border: &mut [f64],
    ) {
        self.evaluate_contact(surface, law, state);
        self.add_evaluated_contact(surface, state, force, border);
        state.deepest = state.points.deepest();
    }

    /// Adds the contact forces, for contact points already evaluated in `state`, to the forces on cylinders
    /// and border.
    pub(crate) fn add_evaluated_contact(
        &self,
        surface: &Surface<'_>,
        state: &mut ChainState,
        force: &mut [f64],
        border: &mut [f64],
    ) {
        state.contact.fill(0.0);
        let points = &state.points;
        let (contact, force) = (&mut state.contact, &mut force[self.range()]);
        let loads = match self.motion {
            Motion::Plane => points.add_plane_forces(contact, force),
            Motion::Space => add_space_forces(points, &state.poses, contact, force),
        };
        let CylinderContact { beam, lost, .. } = loads;
        state.dissipated = lost;
        if let Some(bend) = &surface.bend {
            points.distribute_to_knots(bend.shapes, &mut state.pressure);
        }
        if let Some((on_beam, modal)) = border.split_first_mut() {
            *on_beam -= beam;
            if let Some(bend) = &surface.bend {
                let mut pressed = [0.0; MAX_MODES];
                let pressed = &mut pressed[..modal.len()];
                state.pressure.gather(bend.shapes, pressed);
                for (modal, pressed) in modal.iter_mut().zip(pressed) {
                    *modal -= *pressed;
                }
            }
        }
    }
}

/// Adds the forces of all contact points to the generalised forces of cylinders in space; returns the sum of
/// the loads.
fn add_space_forces(
    points: &Points,
    poses: &[Pose],
    contact: &mut [f64],
    force: &mut [f64],
) -> CylinderContact {
    let mut all = CylinderContact::default();
    for (k, j) in points.touching().enumerate() {
        let sum = points.cylinder_contact(k);
        all.lost += sum.lost;
        all.beam += sum.beam;
        contact[j] = sum.total;
        let row = &mut force[j * BLOCK..(j + 1) * BLOCK];
        row[0] += sum.push.x;
        row[1] += sum.push.y;
        for (k, arm) in InPlane::axis_by(&poses[j]).iter().enumerate() {
            row[BLOCK - 2 + k] += sum.bend.dot(arm);
        }
    }
    all
}
