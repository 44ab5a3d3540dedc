//! Kinematics of one cylinder from its coordinates: six in space, `(x, y, z, phi, theta, psi)`, or three in
//! the plane, `(x, y, psi)`.
//!
//! `R_WB = Rz(psi) Ry(theta) Rx(phi)`, axis `e = R_WB e_x`. Angular velocity `w = phi' e + theta' c + psi' z
//! = E eta'` with `c = Rz e_y`. The angles are singular only where the axis points out of the machine's plane
//! (|theta| = 90 deg), which has its own verdict.
use crate::element::plane::PlaneRod;
use crate::math::elementary::{sin_cos, sin_cos_all};
use crate::math::real::{Vector, WIDEST};
use nalgebra::{Matrix3, Vector2, Vector3};
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

type V2 = Vector2<f64>;
type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Pose and velocity of a cylinder in space, with derivatives that several forces share.
#[derive(Clone, Copy, Debug)]
pub struct Pose {
    /// Position of the cylinder's centre \[m\].
    pub p: V3,
    /// Velocity of the centre [m/s].
    pub v: V3,
    /// Rotation matrix of the cylinder (`R_WB`); column 0 is its axis.
    pub R: M3,
    /// Angular velocity of the cylinder, in the world frame W [rad/s].
    pub w: V3,
    /// Rates of the cylinder's three angles [rad/s].
    pub rate: V3,
    /// Derivatives of the axis with respect to theta and psi.
    pub axis_by: [V3; 2],
    /// Direction `c = Rz(psi) e_y`, about which the angle theta rotates.
    pub c: V3,
    /// Derivative of the direction `c` with respect to the angle psi.
    pub c_by_psi: V3,
    /// Sine and cosine of the cylinder's angle theta out of the plane.
    pub tilt: [f64; 2],
}

impl Pose {
    /// Computes a pose from the six coordinates and their rates.
    pub fn new(q: &[f64], v: &[f64]) -> Self {
        let (s1, c1) = sin_cos(q[3]);
        let (s2, c2) = sin_cos(q[4]);
        let (s3, c3) = sin_cos(q[5]);
        let e = V3::new(c3 * c2, s3 * c2, -s2);
        let c = V3::new(-s3, c3, 0.0);
        let n = V3::new(c3 * s2, s3 * s2, c2);
        let rate = V3::new(v[3], v[4], v[5]);
        Self {
            p: V3::new(q[0], q[1], q[2]),
            v: V3::new(v[0], v[1], v[2]),
            R: M3::from_columns(&[e, c * c1 + n * s1, n * c1 - c * s1]),
            w: e * rate.x + c * rate.y + V3::new(0.0, 0.0, rate.z),
            rate,
            axis_by: [-n, V3::new(-s3 * c2, c3 * c2, 0.0)],
            c,
            c_by_psi: V3::new(-c3, -s3, 0.0),
            tilt: [s2, c2],
        }
    }

    /// Returns the axis of the cylinder.
    pub fn axis(&self) -> V3 {
        self.R.column(0).into_owned()
    }

    /// Returns the matrix `E` that converts rates of the cylinder's angles to its angular velocity, and
    /// changes of the angles to a rotation.
    pub fn angular(&self) -> M3 {
        M3::from_columns(&[self.axis(), self.c, V3::z()])
    }

    /// Returns the derivative of the angular velocity with respect to the angles, at constant rates.
    pub fn angular_rate(&self) -> M3 {
        M3::from_columns(&[
            V3::zeros(),
            self.axis_by[0] * self.rate.x,
            self.axis_by[1] * self.rate.x + self.c_by_psi * self.rate.y,
        ])
    }

    /// Returns the derivative of the generalised torque `E^T tau` with respect to the cylinder's angles, for
    /// a constant torque `tau`.
    pub fn torque_by_angles(&self, tau: &V3) -> M3 {
        M3::new(
            0.0,
            self.axis_by[0].dot(tau),
            self.axis_by[1].dot(tau),
            0.0,
            0.0,
            self.c_by_psi.dot(tau),
            0.0,
            0.0,
            0.0,
        )
    }

    /// Returns the second derivatives of the axis: twice by theta, by theta and psi, twice by psi.
    pub fn axis_by_twice(&self) -> [V3; 3] {
        let e = self.axis();
        let n = -self.axis_by[0];
        [-e, V3::new(n.y, -n.x, 0.0), V3::new(-e.x, -e.y, 0.0)]
    }

    /// Returns the derivatives of the velocity of the axis with respect to theta and psi.
    pub fn axis_velocity_by(&self) -> [V3; 2] {
        let [tt, tp, pp] = self.axis_by_twice();
        [
            tt * self.rate.y + tp * self.rate.z,
            tp * self.rate.y + pp * self.rate.z,
        ]
    }

    /// Returns the time derivative of the cylinder's axis direction [1/s].
    pub fn axis_velocity(&self) -> V3 {
        self.axis_by[0] * self.rate.y + self.axis_by[1] * self.rate.z
    }
}

/// Pose and velocity of a cylinder that moves in the machine's plane.
#[derive(Clone, Copy, Debug)]
pub struct PlanePose {
    /// Position of the cylinder's centre \[m\].
    pub p: V2,
    /// Velocity of the centre [m/s].
    pub v: V2,
    /// Direction of the cylinder's axis, in the plane.
    pub axis: V2,
    /// Angle of the axis from +x \[rad\].
    pub angle: f64,
    /// Rate of the cylinder's angle [rad/s].
    pub rate: f64,
}

impl PlanePose {
    /// Builds a plane pose from the cylinder's three coordinates, their rates, and the axis direction at that
    /// angle.
    #[inline]
    pub fn new(q: &[f64], v: &[f64], axis: V2) -> Self {
        Self {
            p: V2::new(q[0], q[1]),
            v: V2::new(v[0], v[1]),
            axis,
            angle: q[2],
            rate: v[2],
        }
    }

    /// Converts the plane pose to a pose in space.
    pub fn in_space(&self) -> Pose {
        let e = V3::new(self.axis.x, self.axis.y, 0.0);
        let c = V3::new(-e.y, e.x, 0.0);
        Pose {
            p: V3::new(self.p.x, self.p.y, 0.0),
            v: V3::new(self.v.x, self.v.y, 0.0),
            R: M3::from_columns(&[e, c, V3::z()]),
            w: V3::new(0.0, 0.0, self.rate),
            rate: V3::new(0.0, 0.0, self.rate),
            axis_by: [-V3::z(), c],
            c,
            c_by_psi: -e,
            tilt: [0.0, 1.0],
        }
    }
}

/// Poses and velocities of the cylinders of a chain in the plane, one array per quantity, so that several
/// cylinders are processed side by side in SIMD lanes. Arrays are padded with zeros beyond the last cylinder.
#[derive(Clone, Debug, Default)]
pub struct PlanePoses {
    count: usize,
    /// Position of the centres \[m\]; the field `velocity` holds their velocities [m/s].
    place: [Vec<f64>; 2],
    velocity: [Vec<f64>; 2],
    /// Directions of the axes: cosines and sines of their angles.
    axis: [Vec<f64>; 2],
    /// Angles of the axes from +x \[rad\]; the field `rate` holds their rates [rad/s].
    angle: Vec<f64>,
    rate: Vec<f64>,
}

impl PlanePoses {
    /// Allocates the poses of `count` cylinders.
    pub(crate) fn new(count: usize) -> Self {
        // a joint reads the cylinders of its own lane and of the next one
        let zeros = || vec![0.0; count.next_multiple_of(WIDEST) + WIDEST];
        Self {
            count,
            place: [zeros(), zeros()],
            velocity: [zeros(), zeros()],
            axis: [zeros(), zeros()],
            angle: zeros(),
            rate: zeros(),
        }
    }

    /// Returns the number of cylinders.
    pub const fn len(&self) -> usize {
        self.count
    }

    /// Returns whether there are no cylinders.
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Computes the poses from the coordinates `q` of the cylinders and their rates `v`, three numbers each.
    pub(crate) fn fill(&mut self, q: &[f64], v: &[f64]) {
        Arch::new().dispatch(FillPoses { poses: self, q, v });
    }

    /// Returns the pose of cylinder `j`.
    #[inline]
    pub fn get(&self, j: usize) -> PlanePose {
        let at = |[x, y]: &[Vec<f64>; 2]| V2::new(x[j], y[j]);
        PlanePose {
            p: at(&self.place),
            v: at(&self.velocity),
            axis: at(&self.axis),
            angle: self.angle[j],
            rate: self.rate[j],
        }
    }

    /// Iterates over the poses of all cylinders.
    pub fn iter(&self) -> impl Iterator<Item = PlanePose> + '_ {
        (0..self.count).map(|j| self.get(j))
    }

    /// Returns the cylinders from the first to the last whose centre is less than `reach` away from `center`
    /// \[m\].
    pub(crate) fn within(&self, reach: f64, center: V2) -> Range<usize> {
        let [x, y] = self.place.each_ref().map(|array| &array[..self.count]);
        let near =
            |(x, y): (&f64, &f64)| (x - center.x).powi(2) + (y - center.y).powi(2) < reach * reach;
        let mut all = x.iter().zip(y);
        let first = all.position(near).unwrap_or(0);
        let end = x
            .iter()
            .zip(y)
            .rposition(near)
            .map_or(first, |last| last + 1);
        first..end
    }

    /// Returns cylinder `j` as a rod of a joint.
    pub(crate) fn rod(&self, j: usize) -> PlaneRod<f64> {
        let at = |[x, y]: &[Vec<f64>; 2]| [x[j], y[j]];
        PlaneRod {
            place: at(&self.place),
            velocity: at(&self.velocity),
            axis: at(&self.axis),
            angle: self.angle[j],
            rate: self.rate[j],
        }
    }

    /// Returns the cylinders from number `first` on, in `vectors` vectors of SIMD lanes, as rods of joints.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(crate) fn rods<S: Simd>(&self, simd: S, first: usize, vectors: usize) -> PlaneRods<'_, S> {
        let [px, py] = &self.place;
        let [vx, vy] = &self.velocity;
        let [cosine, sine] = &self.axis;
        PlaneRods {
            simd,
            arrays: [px, py, vx, vy, cosine, sine, &self.angle, &self.rate]
                .map(|array| &S::as_simd_f64s(&array[first..]).0[..vectors]),
        }
    }
}

/// Cylinders as rods of joints, in SIMD lanes.
pub(crate) struct PlaneRods<'a, S: Simd> {
    simd: S,
    arrays: [&'a [S::f64s]; 8],
}

impl<S: Simd> PlaneRods<'_, S> {
    /// Returns the `k`-th vector of rods.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(crate) fn get(&self, k: usize) -> PlaneRod<Vector<S>> {
        let [px, py, vx, vy, cosine, sine, angle, rate] =
            self.arrays.map(|array| Vector::new(self.simd, array[k]));
        PlaneRod {
            place: [px, py],
            velocity: [vx, vy],
            axis: [cosine, sine],
            angle,
            rate,
        }
    }
}

/// Arguments of [`PlanePoses::fill`], compiled for each set of instructions.
struct FillPoses<'a> {
    poses: &'a mut PlanePoses,
    q: &'a [f64],
    v: &'a [f64],
}

impl WithSimd for FillPoses<'_> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { poses, q, v } = self;
        let n = poses.count;
        let PlanePoses {
            place: [px, py],
            velocity: [vx, vy],
            axis: [cosine, sine],
            angle,
            rate,
            ..
        } = poses;
        for (from, [x, y, turn]) in [(q, [px, py, angle]), (v, [vx, vy, rate])] {
            let (from, _) = from.as_chunks::<3>();
            let all = x[..n].iter_mut().zip(&mut y[..n]).zip(&mut turn[..n]);
            for (((x, y), turn), from) in all.zip(from) {
                [*x, *y, *turn] = *from;
            }
        }
        sin_cos_all(&poses.angle[..n], &mut sine[..n], &mut cosine[..n]);
    }
}

/// Kinematic quantities of a cylinder that contact in the machine's plane requires; its axis depends on its
/// last `A` coordinates, the angles.
pub(crate) trait InPlane<const A: usize> {
    /// Returns the position of the cylinder's centre in the plane \[m\].
    fn center(&self) -> V2;
    /// Returns the velocity of the centre [m/s].
    fn velocity(&self) -> V2;
    fn axis_by(&self) -> [V2; A];
    /// Returns the second derivative of the axis with respect to the angles `a` and `b`.
    fn axis_by_twice(&self, a: usize, b: usize) -> V2;
    /// Returns the time derivative of the cylinder's axis direction [1/s].
    fn sweep(&self) -> V2;
    /// Returns the derivatives of the axis's time derivative with respect to the angles.
    fn sweep_by(&self) -> [V2; A];
}

impl InPlane<2> for Pose {
    fn center(&self) -> V2 {
        self.p.xy()
    }

    fn velocity(&self) -> V2 {
        self.v.xy()
    }

    fn axis_by(&self) -> [V2; 2] {
        self.axis_by.map(|axis| axis.xy())
    }

    fn axis_by_twice(&self, a: usize, b: usize) -> V2 {
        Self::axis_by_twice(self)[a + b].xy()
    }

    fn sweep(&self) -> V2 {
        self.axis_velocity().xy()
    }

    fn sweep_by(&self) -> [V2; 2] {
        self.axis_velocity_by().map(|sweep| sweep.xy())
    }
}

impl InPlane<1> for PlanePose {
    #[inline]
    fn center(&self) -> V2 {
        self.p
    }

    #[inline]
    fn velocity(&self) -> V2 {
        self.v
    }

    #[inline]
    fn axis_by(&self) -> [V2; 1] {
        [V2::new(-self.axis.y, self.axis.x)]
    }

    fn axis_by_twice(&self, _a: usize, _b: usize) -> V2 {
        -self.axis
    }

    #[inline]
    fn sweep(&self) -> V2 {
        V2::new(-self.axis.y, self.axis.x) * self.rate
    }

    fn sweep_by(&self) -> [V2; 1] {
        [-self.axis * self.rate]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let q = [0.3, -0.2, 0.1, 0.7, -0.4, 1.9];
        let v = [0.1, 0.2, -0.3, 0.9, -1.1, 0.6];
        let at = Pose::new(&q, &v);
        let h = 1e-6;
        let tau = V3::new(0.3, -0.7, 0.5);
        for k in 0..3 {
            let step = |h: f64| {
                let mut q = q;
                q[3 + k] += h;
                Pose::new(&q, &v)
            };
            let (plus, minus) = (step(h), step(-h));
            let w = (plus.w - minus.w) / (2.0 * h);
            assert!((w - at.angular_rate().column(k)).norm() < 1e-9);
            let torque =
                (plus.angular().transpose() * tau - minus.angular().transpose() * tau) / (2.0 * h);
            assert!((torque - at.torque_by_angles(&tau).column(k)).norm() < 1e-9);
            // a change of the angles is a rotation E d eta
            let spin = (plus.R - minus.R) / (2.0 * h);
            let expected = crate::math::rotation::skew(&at.angular().column(k).into_owned()) * at.R;
            assert!((spin - expected).norm() < 1e-9);
            if k > 0 {
                let velocity = (plus.axis_velocity() - minus.axis_velocity()) / (2.0 * h);
                assert!((velocity - at.axis_velocity_by()[k - 1]).norm() < 1e-9);
            }
        }
        assert!((at.w.cross(&at.axis()) - at.axis_velocity()).norm() < 1e-12);
    }
}
