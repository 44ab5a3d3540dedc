//! Joint between two rods in a plane: the map from their coordinates to the joint's deformations.
//!
//! The deformations are extension and shear, along and across the axis of rod J, and the turn of rod I
//! relative to J. A [`ForceLaw`](super::law::ForceLaw) of these three answers with forces; this module returns
//! the forces on the rods, and the stiffness and damping by their coordinates.
use super::law::LawResponse;
use crate::math::real::Real;
use std::f64::consts::TAU;

/// Number of deformations of a planar joint: extension, shear, turn.
pub const DEFORMATIONS: usize = 3;
/// Number of independent coordinates of a planar joint: x, y and angle of I, angle of J. The joint depends on
/// the difference of the rods' positions, so derivatives with respect to those of J are the opposite.
pub(crate) const INDEPENDENT: usize = 4;

/// Pose and velocity of a rod in the plane.
#[derive(Clone, Copy, Debug)]
pub struct PlaneRod<T> {
    /// Position of the rod's centre \[m\].
    pub place: [T; 2],
    /// Velocity of the centre [m/s].
    pub velocity: [T; 2],
    /// Direction of the rod's axis: cosine and sine of its angle.
    pub axis: [T; 2],
    /// Angle of the axis from +x \[rad\].
    pub angle: T,
    /// Rate of the angle [rad/s].
    pub rate: T,
}

/// Joint between the near ends of two rods of equal length, at one pose and velocity of both.
#[derive(Clone, Copy, Debug)]
pub struct PlaneJoint<T> {
    /// Extension \[m\], shear \[m\] and turn \[rad\].
    pub deformation: [T; DEFORMATIONS],
    /// Rates of the deformations.
    pub rate: [T; DEFORMATIONS],
    /// Half the length of a rod \[m\].
    half: f64,
    /// Axis of rod J, and of rod I in the frame of J.
    axis: [T; 2],
    turned: [T; 2],
    /// Rate of the angle of rod J [rad/s].
    spin: T,
}

/// Force and torques of a planar joint on its two rods.
#[derive(Clone, Copy, Debug)]
pub struct PlaneLoad<T> {
    /// Force on rod I \[N\]; the opposite force acts on rod J.
    pub force: [T; 2],
    /// Torques on rod I and on rod J about their centres [N m].
    pub torque: [T; 2],
}

/// Derivatives of the forces of a planar joint, negative, by the coordinates of both rods: three by three
/// blocks of the rows of I and J and the columns of I and J.
#[derive(Clone, Copy, Debug)]
pub struct PlaneTangent<T>(pub(crate) [[T; INDEPENDENT]; INDEPENDENT]);

/// Rod of a planar joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Rod I, behind the joint.
    I,
    /// Rod J, before the joint, whose frame defines extension and shear.
    J,
}

/// Rounds to an integer when added to a number and subtracted again: 1.5 times 2^52.
const ROUND: f64 = 6_755_399_441_055_744.0;

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
impl<T: Real> PlaneJoint<T> {
    /// Computes the deformations of the joint between the end of rod J and the start of rod I, both of length
    /// `2 half` \[m\].
    #[inline(always)]
    pub fn new(half: f64, i: &PlaneRod<T>, j: &PlaneRod<T>) -> Self {
        let ([ex, ey], [ix, iy]) = (j.axis, i.axis);
        // in the order of the bushing in space, which rounds alike
        let ([ax, ay], [bx, by]) = ([ix * -half, iy * -half], [ex * half, ey * half]);
        let dx = (i.place[0] + ax) - (j.place[0] + bx);
        let dy = (i.place[1] + ay) - (j.place[1] + by);
        let wx = (i.velocity[0] - ay * i.rate) - (j.velocity[0] - by * j.rate);
        let wy = (i.velocity[1] + ax * i.rate) - (j.velocity[1] + bx * j.rate);
        let extension = ex * dx + ey * dy;
        let shear = ex * dy - ey * dx;
        let turn = i.angle - j.angle;
        let turns = (turn * (1.0 / TAU) + ROUND) - ROUND;
        Self {
            deformation: [extension, shear, turn - turns * TAU],
            rate: [
                ex * wx + ey * wy + j.rate * shear,
                ex * wy - ey * wx - j.rate * extension,
                i.rate - j.rate,
            ],
            half,
            axis: [ex, ey],
            turned: [ex * ix + ey * iy, ex * iy - ey * ix],
            spin: j.rate,
        }
    }

    /// Returns the joint's force and torques on the rods under the forces that resist its deformations.
    #[inline(always)]
    pub fn load(&self, [along, across, bending]: [T; DEFORMATIONS]) -> PlaneLoad<T> {
        let ([ex, ey], [cosine, sine]) = (self.axis, self.turned);
        let [extension, shear, _] = self.deformation;
        PlaneLoad {
            force: [ey * across - ex * along, -(ey * along + ex * across)],
            torque: [
                (cosine * across - sine * along) * self.half - bending,
                bending - shear * along + (extension + self.half) * across,
            ],
        }
    }

    /// Returns the joint's stiffness and its damping by the coordinates of both rods, under the response of its
    /// law, in which each force depends on its own deformation alone: other derivatives are not read.
    #[inline(always)]
    pub fn tangents(&self, law: &LawResponse<T, DEFORMATIONS>) -> [PlaneTangent<T>; 2] {
        let ([ex, ey], [cosine, sine]) = (self.axis, self.turned);
        let (half, spin) = (self.half, self.spin);
        let [extension, shear, _] = self.deformation;
        let [stretching, shearing, turning] = self.rate;
        let zero = ex.constant(0.0);
        // rows: extension and shear; columns: x, y and angle of I, angle of J
        let by = [
            [ex, ey, sine * half, shear],
            [-ey, ex, -(cosine * half), -(extension + half)],
        ];
        let by_rate = [
            [-(spin * ey), spin * ex, cosine * half * turning, shearing],
            [
                -(spin * ex),
                -(spin * ey),
                sine * half * turning,
                -stretching,
            ],
        ];
        let [along, across, _] = law.force;
        let swing = (along * cosine + across * sine) * half;
        let (x, y) = (-(along * ey) - across * ex, along * ex - across * ey);
        let last = -(along * (extension + half)) - across * shear;
        // the forces times the second derivatives of the deformations
        let mut stiffness = [
            [zero, zero, zero, x],
            [zero, zero, zero, y],
            [zero, zero, swing, -swing],
            [x, y, -swing, last],
        ];
        let mut damping = [[zero; INDEPENDENT]; INDEPENDENT];
        for (r, (by, by_rate)) in by.into_iter().zip(by_rate).enumerate() {
            let (spring, damper) = (law.stiffness[r][r], law.damping[r][r]);
            for column in 0..INDEPENDENT {
                let c = damper * by[column];
                let k = spring * by[column] + damper * by_rate[column];
                for row in 0..INDEPENDENT {
                    stiffness[row][column] = stiffness[row][column] + by[row] * k;
                    damping[row][column] = damping[row][column] + by[row] * c;
                }
            }
        }
        // the turn is the difference of the two angles
        for (sum, by) in [
            (&mut stiffness, law.stiffness[2][2]),
            (&mut damping, law.damping[2][2]),
        ] {
            sum[2][2] = sum[2][2] + by;
            sum[2][3] = sum[2][3] - by;
            sum[3][2] = sum[3][2] - by;
            sum[3][3] = sum[3][3] + by;
        }
        [PlaneTangent(stiffness), PlaneTangent(damping)]
    }
}

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
impl<T: Real> PlaneTangent<T> {
    /// Returns the sum of the tangent and `factor` times another one.
    #[inline(always)]
    #[must_use]
    pub fn plus(&self, factor: f64, other: &Self) -> Self {
        let row = |r: usize| std::array::from_fn(|c| self.0[r][c] + other.0[r][c] * factor);
        Self(std::array::from_fn(row))
    }
}

impl PlaneLoad<f64> {
    /// Returns the generalised forces of the joint on x, y and angle of rod J, then on those of rod I.
    #[inline]
    pub const fn on_coordinates(&self) -> [f64; 6] {
        let ([x, y], [torque_i, torque_j]) = (self.force, self.torque);
        [-x, -y, torque_j, x, y, torque_i]
    }
}

impl PlaneTangent<f64> {
    /// Returns the entry in the row of coordinate `row` of one rod and the column of coordinate `column` of a
    /// rod; coordinates are x, y and angle.
    #[expect(clippy::inline_always, reason = "sides and coordinates are constants")]
    #[inline(always)]
    pub fn entry(&self, (of, row): (Side, usize), (by, column): (Side, usize)) -> f64 {
        let place = |side: Side, k: usize| match (side, k) {
            (Side::I, k) => (k, 1.0),
            (Side::J, 2) => (3, 1.0),
            (Side::J, k) => (k, -1.0),
        };
        let ((row, above), (column, beside)) = (place(of, row), place(by, column));
        above * beside * self.0[row][column]
    }
}
