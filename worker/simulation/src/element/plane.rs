//! Planar bushing: the law of [`Bushing`] between markers that move in one plane, without the vanishing
//! terms.
//!
//! All axes lie in the plane and all rotations are about its normal, so that a force has two components, a
//! torque one, and the rotation vector is a difference of angles. Torsion does not occur: `K_44` and `C_44`
//! have no influence.
use super::bushing::{AxialTension, Bushing};
use nalgebra::Vector2;
use std::f64::consts::{PI, TAU};

type V2 = Vector2<f64>;

/// Planar marker: a frame fixed on a body, with the motion of that body.
#[derive(Clone, Copy, Debug)]
pub struct PlaneMarker {
    /// Position of the body's reference point \[m\].
    pub p: V2,
    /// Vector from the body's reference point to the marker \[m\].
    pub rho: V2,
    /// Velocity of the body's reference point [m/s].
    pub v: V2,
    /// Angular velocity of the body [rad/s].
    pub w: f64,
    /// Unit vector along the marker's axis.
    pub axis: V2,
    /// Angle of the marker's axis from +x \[rad\].
    pub angle: f64,
}

/// Force and torques that a planar joint exerts on its two bodies I and J; torques are about the bodies'
/// reference points.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlaneLoad {
    /// Force on body I \[N\]; the opposite force acts on body J.
    pub force: V2,
    /// Torque on body I about its reference point [N m].
    pub torque_i: f64,
    /// Torque on body J about its reference point [N m].
    pub torque_j: f64,
    /// Component of the joint force along the axis of marker J; negative where the joint pulls \[N\].
    pub axial: f64,
    /// Power dissipated by the joint's damping \[W\].
    pub dissipated: f64,
}

/// Number of coefficients of a planar joint: three stiffnesses, three damping coefficients and the preload.
pub const PLANE_COEFFICIENTS: usize = 7;
/// Index of the preload (tension along the axis) among the coefficients of a planar joint.
pub const PRELOAD_INDEX: usize = 6;

/// Derivatives of a planar joint's force and torques with respect to one coordinate of a body.
#[derive(Clone, Copy, Debug)]
pub struct PlaneColumn {
    /// Derivative of the force on body I with respect to the coordinate.
    pub force: V2,
    /// Derivative of the torque on body I with respect to the coordinate.
    pub torque_i: f64,
    /// Derivative of the torque on body J with respect to the coordinate.
    pub torque_j: f64,
}

/// Computes `z x r`, the vector rotated by +90 degrees.
#[inline]
fn perp(r: &V2) -> V2 {
    V2::new(-r.y, r.x)
}

/// Computes the z component of `a x b`.
#[inline]
fn cross_z(a: &V2, b: &V2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Computes the difference of two angles, reduced to the range of -pi to pi \[rad\].
#[inline]
fn turned(i: f64, j: f64) -> f64 {
    let turn = i - j;
    if turn.abs() > PI {
        turn - TAU * (turn / TAU).round()
    } else {
        turn
    }
}

/// Motion of marker I relative to marker J: position and its rate in the frame of J, angle and its rate; used
/// by both load and tangent.
struct Deformation {
    d: V2,
    V: V2,
    theta: f64,
    w: f64,
}

#[inline]
fn deformation(i: &PlaneMarker, j: &PlaneMarker) -> Deformation {
    let d = (i.p + i.rho) - (j.p + j.rho);
    let velocity = (i.v + perp(&i.rho) * i.w) - (j.v + perp(&j.rho) * j.w);
    Deformation {
        d,
        V: velocity - perp(&d) * j.w,
        theta: turned(i.angle, j.angle),
        w: i.w - j.w,
    }
}

impl PlaneColumn {
    fn opposite(self) -> Self {
        Self {
            force: -self.force,
            torque_i: -self.torque_i,
            torque_j: -self.torque_j,
        }
    }
}

impl PlaneLoad {
    /// Adds the force and torques of an additional axial tension between the markers to the load.
    #[inline]
    pub fn add_pull(&mut self, (i, j): (&PlaneMarker, &PlaneMarker), pull: &AxialTension) {
        let Deformation { d, .. } = deformation(i, j);
        let force = j.axis * -pull.force;
        self.force += force;
        self.torque_i += cross_z(&i.rho, &force);
        self.torque_j -= cross_z(&(d + j.rho), &force);
        self.axial -= pull.force;
        self.dissipated += pull.dissipated;
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "the law in the plane is a file of its own"
)]
impl Bushing {
    /// Computes the joint's force and torques ([`Self::load`]) for planar motion.
    #[inline]
    pub fn plane_load(&self, i: &PlaneMarker, j: &PlaneMarker) -> PlaneLoad {
        let [k1, k2] = self.stiffness;
        let [c1, c2] = self.damping;
        let [k5, c5] = [self.rotational_stiffness[1], self.rotational_damping[1]];
        let Deformation { d, V, theta, w } = deformation(i, j);
        let e = j.axis;
        let damping = V * c2 + e * ((c1 - c2) * e.dot(&V));
        let force = -(d * k2 + e * ((k1 - k2) * e.dot(&d) + self.preload) + damping);
        let bending_damping = w * c5;
        let torque = -(theta * k5 + bending_damping);
        PlaneLoad {
            force,
            torque_i: torque + cross_z(&i.rho, &force),
            torque_j: -torque - cross_z(&(d + j.rho), &force),
            axial: e.dot(&force),
            dissipated: damping.dot(&V) + bending_damping * w,
        }
    }

    /// Computes, for planar motion, the extension of the joint along its axis \[m\] and its rate [m/s].
    #[inline]
    pub fn plane_extension(&self, i: &PlaneMarker, j: &PlaneMarker) -> [f64; 2] {
        let Deformation { d, V, .. } = deformation(i, j);
        [j.axis.dot(&d), j.axis.dot(&V)]
    }

    /// Computes the elastic energy stored in the joint for planar motion \[J\].
    pub fn plane_energy(&self, i: &PlaneMarker, j: &PlaneMarker) -> f64 {
        let [k1, k2] = self.stiffness;
        let Deformation { d, theta, .. } = deformation(i, j);
        let axial = j.axis.dot(&d);
        self.preload * axial
            + 0.5 * (k2 * d.norm_squared() + (k1 - k2) * axial * axial)
            + 0.5 * self.rotational_stiffness[1] * theta * theta
    }

    /// Computes the derivatives of [`Self::plane_load`] by x, y and angle of I and of J, where each rate
    /// changes `gamma` times as much as its coordinate; includes an additional tension that `force` already
    /// contains.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub fn plane_tangent(
        &self,
        (i, j): (&PlaneMarker, &PlaneMarker),
        force: &V2,
        gamma: f64,
        further: Option<&AxialTension>,
    ) -> [[PlaneColumn; 3]; 2] {
        let [mut k1, k2] = self.stiffness;
        let [mut c1, c2] = self.damping;
        let Deformation { d, V, w, .. } = deformation(i, j);
        let mut pull = self.preload + (k1 - k2) * j.axis.dot(&d) + (c1 - c2) * j.axis.dot(&V);
        if let Some(further) = further {
            pull += further.force;
            k1 += further.by_extension;
            c1 += further.by_rate;
        }
        let e = j.axis;
        let stiff = |x: V2| x * k2 + e * ((k1 - k2) * e.dot(&x));
        let damp = |x: V2| x * c2 + e * ((c1 - c2) * e.dot(&x));
        let bend = self.rotational_stiffness[1] + gamma * self.rotational_damping[1];
        // how the force turns with the axis of J
        let side = perp(&e);
        let sweep = side * pull + e * side.dot(&(d * (k1 - k2) + V * (c1 - c2)));
        let arm = d + j.rho;
        let turn_i = perp(&i.rho);

        let by_place = |x: V2| -stiff(x) - damp(x * gamma - perp(&x) * j.w);
        let force_x = by_place(V2::x());
        let force_y = by_place(V2::y());
        let force_i = -stiff(turn_i) - damp(turn_i * gamma - i.rho * w);
        let force_j = -sweep + stiff(perp(&j.rho)) + damp(perp(&arm) * gamma);

        let column = |by: V2, torque: f64, own: f64, reaction: f64| PlaneColumn {
            force: by,
            torque_i: torque + cross_z(&i.rho, &by) + own,
            torque_j: -torque - cross_z(&arm, &by) + reaction,
        };
        // with I moves its arm about J's reference point, with its angle also its arm about its own
        let along = force.dot(&i.rho);
        [
            [
                column(force_x, 0.0, 0.0, -force.y),
                column(force_y, 0.0, 0.0, force.x),
                column(force_i, -bend, -along, along),
            ],
            [
                column(-force_x, 0.0, 0.0, force.y),
                column(-force_y, 0.0, 0.0, -force.x),
                column(force_j, bend, 0.0, 0.0),
            ],
        ]
    }

    /// Computes [`Self::plane_tangent`] for `gamma = 0` and for the given `gamma` at once.
    #[expect(clippy::inline_always, reason = "too much to be handed over by copies")]
    #[inline(always)]
    pub fn plane_tangents(
        &self,
        (i, j): (&PlaneMarker, &PlaneMarker),
        force: &V2,
        gamma: f64,
        further: Option<&AxialTension>,
    ) -> [[[PlaneColumn; 3]; 2]; 2] {
        let [mut k1, k2] = self.stiffness;
        let [mut c1, c2] = self.damping;
        let Deformation { d, V, w, .. } = deformation(i, j);
        let e = j.axis;
        let side = perp(&e);
        let mut pull = self.preload + (k1 - k2) * e.dot(&d) + (c1 - c2) * e.dot(&V);
        if let Some(further) = further {
            pull += further.force;
            k1 += further.by_extension;
            c1 += further.by_rate;
        }
        let stiff = |x: V2| x * k2 + e * ((k1 - k2) * e.dot(&x));
        let damp = |x: V2| x * c2 + e * ((c1 - c2) * e.dot(&x));
        let turned = side.dot(&(d * (k1 - k2) + V * (c1 - c2)));
        let arm = d + j.rho;
        let [damp_x, damp_y, damp_i] = [V2::x(), V2::y(), i.rho].map(damp);
        let turn_i = perp(&i.rho);
        // by x, y and the angle of I, by the angle of J
        let by_place = [
            damp_y * j.w - stiff(V2::x()),
            -damp_x * j.w - stiff(V2::y()),
            damp_i * w - stiff(turn_i),
            stiff(perp(&j.rho)) - side * pull - e * turned,
        ];
        let by_rate = [-damp_x, -damp_y, -damp(turn_i), damp(perp(&arm))];
        let along = force.dot(&i.rho);
        let columns = |by: [V2; 4], bend: f64| {
            let column = |by: V2, torque: f64, own: f64, reaction: f64| PlaneColumn {
                force: by,
                torque_i: torque + cross_z(&i.rho, &by) + own,
                torque_j: -torque - cross_z(&arm, &by) + reaction,
            };
            let [x, y] = [
                column(by[0], 0.0, 0.0, -force.y),
                column(by[1], 0.0, 0.0, force.x),
            ];
            [
                [x, y, column(by[2], -bend, -along, along)],
                [x.opposite(), y.opposite(), column(by[3], bend, 0.0, 0.0)],
            ]
        };
        let [k5, c5] = [self.rotational_stiffness[1], self.rotational_damping[1]];
        let whole = std::array::from_fn(|k| by_place[k] + by_rate[k] * gamma);
        [columns(by_place, k5), columns(whole, k5 + gamma * c5)]
    }

    /// Returns the joint's coefficients in the order of [`Self::plane_units`]; the unit forces of that
    /// function, multiplied by these coefficients, sum to the joint's forces.
    pub const fn plane_coefficients(&self) -> [f64; PLANE_COEFFICIENTS] {
        let ([k1, k2], [c1, c2]) = (self.stiffness, self.damping);
        let [[_, k5], [_, c5]] = [self.rotational_stiffness, self.rotational_damping];
        [k1, k2, k5, c1, c2, c5, self.preload]
    }

    /// Computes the generalised forces of a joint per unit of `K_11`, `K_22`, `K_55`, `C_11`, `C_22`, `C_55`
    /// and preload, in which the forces are linear; first on the three coordinates of body J, then on those
    /// of I.
    #[inline]
    pub fn plane_units((i, j): (&PlaneMarker, &PlaneMarker)) -> [[f64; PLANE_COEFFICIENTS]; 6] {
        let Deformation { d, V, theta, w } = deformation(i, j);
        let e = j.axis;
        let arm = d + j.rho;
        let [along_d, along_v] = [d, V].map(|x| e * e.dot(&x));
        let forces = [-along_d, along_d - d, -along_v, along_v - V, -e];
        let mut units = [[0.0; PLANE_COEFFICIENTS]; 6];
        for (k, force) in [0, 1, 3, 4, PRELOAD_INDEX].into_iter().zip(forces) {
            units[0][k] = -force.x;
            units[1][k] = -force.y;
            units[2][k] = -cross_z(&arm, &force);
            units[3][k] = force.x;
            units[4][k] = force.y;
            units[5][k] = cross_z(&i.rho, &force);
        }
        for (k, turn) in [(2, theta), (5, w)] {
            units[2][k] = turn;
            units[5][k] = -turn;
        }
        units
    }
}
