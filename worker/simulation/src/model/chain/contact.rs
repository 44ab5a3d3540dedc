//! Forces of a chain's contact with an arc, on the cylinders and on whoever carries the arc.
use super::{Chain, ChainState};
use crate::element::impact::Impact;
use crate::math::spline::sum::Spread;
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
        let width = self.motion.width();
        if let Some(bend) = &surface.bend {
            state.pressure.clear(bend.shapes);
        }
        let mut contact = Contact {
            chain: self,
            surface,
            law,
            pressure: &mut state.pressure,
            beam: 0.0,
            deepest: 0.0,
            dissipated: 0.0,
        };
        let rows = force[self.range()].chunks_exact_mut(width);
        let totals = state.contact.iter_mut().zip(rows);
        match self.motion {
            Motion::Plane => {
                for (pose, (total, force)) in state.plane.iter().zip(totals) {
                    *total = contact.add(pose, force);
                }
            }
            Motion::Space => {
                for (pose, (total, force)) in state.poses.iter().zip(totals) {
                    *total = contact.add(pose, force);
                }
            }
        }
        let Contact {
            beam,
            deepest,
            dissipated,
            ..
        } = contact;
        state.deepest = deepest;
        state.dissipated = dissipated;
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

/// One evaluation of a chain's contact.
struct Contact<'a> {
    chain: &'a Chain,
    surface: &'a Surface<'a>,
    law: &'a Impact,
    /// Forces on a deflected arc, spread over the knots of its shapes.
    pressure: &'a mut Spread,
    /// Moment that the beam takes up \[N m\].
    beam: f64,
    deepest: f64,
    dissipated: f64,
}

impl Contact<'_> {
    /// Adds the forces on one cylinder to its rows and on what carries the arc; returns how hard it is pressed
    /// \[N\].
    #[inline]
    fn add<const A: usize>(&mut self, pose: &impl InPlane<A>, force: &mut [f64]) -> f64 {
        let half = 0.5 * self.chain.pitch;
        let center = pose.center();
        let Some(bearing) = self.surface.bearing(&center, half) else {
            return 0.0;
        };
        let angles = force.len() - A;
        let (velocity, axis, sweep) = (pose.velocity(), pose.axis(), pose.sweep());
        let mut total = 0.0;
        for &(place, share) in self.chain.contact_points {
            let along = place * half;
            let (g, velocity) = (center + axis * along, velocity + sweep * along);
            let Some(touch) = self.surface.touch(&bearing, &g, &velocity) else {
                continue;
            };
            self.deepest = self.deepest.max(touch.depth);
            let (force_here, dissipated) = self.law.push(touch.depth, touch.rate);
            self.dissipated += share * dissipated;
            let f = share * force_here;
            if f == 0.0 {
                continue;
            }
            total += f;
            let push = touch.by_point * -f;
            force[0] += push.x;
            force[1] += push.y;
            for (k, arm) in pose.axis_by().iter().enumerate() {
                force[angles + k] += along * push.dot(arm);
            }
            self.beam += f * touch.by_beam;
            if let Some(place) = &touch.place {
                self.pressure.add(place, f);
            }
        }
        total
    }
}
