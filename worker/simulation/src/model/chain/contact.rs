//! Forces of a chain's contact with an arc, on the cylinders and on whoever carries the arc.
use super::points::{Points, Pressed};
use super::{Chain, ChainState};
use crate::element::impact::Impact;
use crate::model::MAX_MODES;
use crate::model::contact::{Surface, Touch};
use crate::model::layout::Motion;
use crate::model::pose::InPlane;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the contact forces on the cylinders and on the `border`: the beam angle, then the
    /// modes. An arc that is fixed in W has no border.
    pub(crate) fn add_contact(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        state: &mut ChainState,
        force: &mut [f64],
        border: &mut [f64],
    ) {
        if let Some(bend) = &surface.bend {
            state.pressure.clear(bend.shapes);
        }
        state.contact.fill(0.0);
        let of = self.range();
        let loads = match self.motion {
            Motion::Plane => {
                let poses = &state.plane;
                state.points.evaluate(self, surface, law, poses.iter());
                self.press(&state.points, poses, &mut state.contact, &mut force[of])
            }
            Motion::Space => {
                let poses = &state.poses;
                state.points.evaluate(self, surface, law, poses.iter());
                self.press(&state.points, poses, &mut state.contact, &mut force[of])
            }
        };
        let Pressed { beam, lost, .. } = loads;
        state.deepest = state.points.deepest();
        state.dissipated = lost;
        if surface.bend.is_some() {
            state.points.spread(&mut state.pressure);
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

    /// Adds the forces of all points to the cylinders' rows; returns what they do to whoever carries
    /// the arc.
    fn press<const A: usize>(
        &self,
        points: &Points,
        poses: &[impl InPlane<A>],
        contact: &mut [f64],
        force: &mut [f64],
    ) -> Pressed {
        let width = self.motion.width();
        let mut all = Pressed::default();
        for (k, &j) in points.cylinders().iter().enumerate() {
            let sum = points.pressed(k);
            all.lost += sum.lost;
            all.beam += sum.beam;
            contact[j] = sum.total;
            let row = &mut force[j * width..(j + 1) * width];
            row[0] += sum.push.x;
            row[1] += sum.push.y;
            for (k, arm) in poses[j].axis_by().iter().enumerate() {
                row[width - A + k] += sum.bend.dot(arm);
            }
        }
        all
    }

    /// Calls `visit(share, touch)` for every Gauss point inside the arc.
    pub(crate) fn each_touch(
        &self,
        surface: &Surface<'_>,
        state: &ChainState,
        mut visit: impl FnMut(f64, &Touch),
    ) {
        for pose in &state.poses {
            self.touches(surface, pose, &mut visit);
        }
        for pose in &state.plane {
            self.touches(surface, pose, &mut visit);
        }
    }

    fn touches<const A: usize>(
        &self,
        surface: &Surface<'_>,
        pose: &impl InPlane<A>,
        visit: &mut impl FnMut(f64, &Touch),
    ) {
        let half = 0.5 * self.pitch;
        let Some(bearing) = surface.bearing(&pose.center(), half) else {
            return;
        };
        for &(place, share) in self.contact_points {
            let along = place * half;
            let g = pose.center() + pose.axis() * along;
            let velocity = pose.velocity() + pose.sweep() * along;
            if let Some(touch) = surface.touch(&bearing, &g, &velocity)
                && touch.depth > 0.0
            {
                visit(share, &touch);
            }
        }
    }
}
