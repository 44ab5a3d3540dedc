//! Tangent of a chain's contact with an arc.
//!
//! For the force `Q = -f grad d` of one Gauss point, `-dQ = grad d (df)^T + f H dq` with
//! `df = (f_d + gamma c) grad d + c H q'`: `f_d` and `c` are the law's derivatives by penetration
//! and rate, `H` the second derivatives of the penetration.
use super::{Chain, ChainState};
use crate::element::impact::Impact;
use crate::linear::Bordered;
use crate::model::MAX_MODES;
use crate::model::contact::{Curvature, Surface, Touch};
use crate::model::pose::InPlane;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// Everything about one Gauss point in contact.
struct Point {
    touch: Touch,
    curvature: Curvature,
    /// Distance from the cylinder's centre along its axis \[m\].
    along: f64,
    force: f64,
    /// Derivative of the force by the penetration's rate.
    by_rate: f64,
    /// Derivative of the force by the point and by the border's coordinates.
    by_place: V2,
    border: [BorderColumn; MAX_MODES + 1],
    /// Index of the cylinder's first angle that turns its axis.
    angles: usize,
}

/// One coordinate of the border: the beam angle, then the modes.
#[derive(Clone, Copy, Default)]
struct BorderColumn {
    /// Derivative of the penetration.
    gradient: f64,
    /// Derivative of the force.
    force_by: f64,
    /// Mixed second derivative of the penetration with the point.
    mixed: V2,
    /// Slope of the mode's shape over the arc; the beam angle has none.
    slope: f64,
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Chain {
    /// Adds the contact's tangent to the cylinders' blocks and to the border, if there is one.
    pub(crate) fn add_contact_tangent(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        state: &ChainState,
        gamma: f64,
        matrix: &mut Bordered,
    ) {
        for (j, pose) in state.poses.iter().enumerate() {
            self.add_touching(surface, law, (self.first + j, pose), gamma, matrix);
        }
        for (j, pose) in state.plane.iter().enumerate() {
            self.add_touching(surface, law, (self.first + j, pose), gamma, matrix);
        }
    }

    fn add_touching<const A: usize>(
        &self,
        surface: &Surface<'_>,
        law: &Impact,
        (block, pose): (usize, &impl InPlane<A>),
        gamma: f64,
        matrix: &mut Bordered,
    ) {
        let half = 0.5 * self.pitch;
        let modes = surface.modes();
        let mut shape = [0.0; MAX_MODES];
        let Some(bearing) = surface.bearing(&pose.center(), half) else {
            return;
        };
        for &(place, share) in self.contact_points {
            let along = place * half;
            let g = pose.center() + pose.axis() * along;
            let velocity = pose.velocity() + pose.sweep() * along;
            let Some(touch) = surface.touch(&bearing, &g, &velocity) else {
                continue;
            };
            let at = law.force(touch.depth, touch.rate);
            if at.force == 0.0 {
                continue;
            }
            surface.shapes_at(&touch, &mut shape[..modes]);
            let by_rate = share * at.by_rate;
            let stiff = share * at.by_penetration + gamma * by_rate;
            let mut point = Point {
                curvature: surface.curvature(&touch),
                touch,
                along,
                force: share * at.force,
                by_rate,
                by_place: V2::zeros(),
                border: [BorderColumn::default(); MAX_MODES + 1],
                angles: self.motion.width() - A,
            };
            point.differentiate(surface, &velocity, stiff, &shape[..modes]);
            point.add_cylinder(matrix, block, pose);
            if matrix.border() > 0 {
                point.add_border(matrix, block, pose, modes);
            }
        }
    }
}

impl Point {
    /// Derivatives of the force by the point, the beam angle and the modes.
    fn differentiate(&mut self, surface: &Surface<'_>, velocity: &V2, stiff: f64, shape: &[f64]) {
        let beam_rate = surface.beam[1];
        let (angle_by_point, angle_by_beam) = self.curvature.angle_by;
        let angle_rate = angle_by_point.dot(velocity) + angle_by_beam * beam_rate;
        let mut drift = 0.0;
        if let (Some(bend), Some(at)) = (&surface.bend, &self.touch.place) {
            for (k, &shape) in shape.iter().enumerate() {
                let slope = bend.shapes.jet(at, k).first;
                drift += bend.modal_rate[k] * slope;
                self.border[1 + k] = BorderColumn {
                    gradient: shape,
                    force_by: shape * stiff + slope * angle_rate * self.by_rate,
                    mixed: angle_by_point * slope,
                    slope,
                };
            }
        }
        // rates of the gradient along the motion: H q'
        let point_rate = self.curvature.point * velocity
            + self.curvature.mixed * beam_rate
            + angle_by_point * drift;
        let beam_gradient_rate = self.curvature.mixed.dot(velocity)
            + self.curvature.beam * beam_rate
            + angle_by_beam * drift;
        self.by_place = self.touch.by_point * stiff + point_rate * self.by_rate;
        self.border[0] = BorderColumn {
            gradient: self.touch.by_beam,
            force_by: self.touch.by_beam * stiff + beam_gradient_rate * self.by_rate,
            mixed: self.curvature.mixed,
            slope: 0.0,
        };
    }

    /// How the point's velocity turns with the cylinder's angles, times the damping.
    fn turning<const A: usize>(&self, pose: &impl InPlane<A>) -> [f64; A] {
        pose.sweep_by()
            .map(|sweep| self.by_rate * self.along * self.touch.by_point.dot(&sweep))
    }

    fn arms<const A: usize>(&self, pose: &impl InPlane<A>) -> [V2; A] {
        pose.axis_by().map(|axis| axis * self.along)
    }

    fn add_cylinder<const A: usize>(
        &self,
        matrix: &mut Bordered,
        block: usize,
        pose: &impl InPlane<A>,
    ) {
        let angles = self.angles;
        let mut add = |row, column, value| matrix.add_diagonal(block, row, column, value);
        let gradient = self.touch.by_point;
        let core = gradient * self.by_place.transpose() + self.curvature.point * self.force;
        let (arms, turning) = (self.arms(pose), self.turning(pose));
        for r in 0..2 {
            for c in 0..2 {
                add(r, c, core[(r, c)]);
            }
        }
        for (a, arm) in arms.iter().enumerate() {
            let column = core * arm + gradient * turning[a];
            let row = core.tr_mul(arm);
            for k in 0..2 {
                add(k, angles + a, column[k]);
                add(angles + a, k, row[k]);
            }
            for (b, other) in arms.iter().enumerate() {
                let bend = pose.axis_by_twice(a, b) * self.along;
                let value = arm.dot(&(core * other))
                    + arm.dot(&gradient) * turning[b]
                    + self.force * gradient.dot(&bend);
                add(angles + a, angles + b, value);
            }
        }
    }

    fn add_border<const A: usize>(
        &self,
        matrix: &mut Bordered,
        block: usize,
        pose: &impl InPlane<A>,
        modes: usize,
    ) {
        let angles = self.angles;
        let (arms, turning) = (self.arms(pose), self.turning(pose));
        let (_, angle_by_beam) = self.curvature.angle_by;
        let border = &self.border[..=modes];
        for (k, of) in border.iter().enumerate() {
            let column = self.touch.by_point * of.force_by + of.mixed * self.force;
            let row = self.by_place * of.gradient + of.mixed * self.force;
            for r in 0..2 {
                matrix.add_right(block, r, k, column[r]);
                matrix.add_bottom(block, k, r, row[r]);
            }
            for (a, arm) in arms.iter().enumerate() {
                matrix.add_right(block, angles + a, k, column.dot(arm));
                matrix.add_bottom(
                    block,
                    k,
                    angles + a,
                    row.dot(arm) + of.gradient * turning[a],
                );
            }
            for (m, other) in border.iter().enumerate() {
                let bend = match (k, m) {
                    (0, 0) => self.curvature.beam,
                    (0, _) => angle_by_beam * other.slope,
                    (_, 0) => angle_by_beam * of.slope,
                    _ => 0.0,
                };
                matrix.add_corner(k, m, of.gradient * other.force_by + bend * self.force);
            }
        }
    }
}
