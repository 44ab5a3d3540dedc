//! Kinematics of one cylinder from its coordinates: six in space, `(x, y, z, phi, theta, psi)`, or three in
//! the plane, `(x, y, psi)`.
//!
//! `R_WB = Rz(psi) Ry(theta) Rx(phi)`, axis `e = R_WB e_x`. Angular velocity `w = phi' e + theta' c + psi' z
//! = E eta'` with `c = Rz e_y`. The angles are singular only where the axis points out of the machine's plane
//! (|theta| = 90 deg), which has its own verdict.
use crate::math::elementary::sin_cos;
use nalgebra::{Matrix3, Vector2, Vector3};

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

/// Kinematic quantities of a cylinder that contact in the machine's plane requires; its axis depends on its
/// last `A` coordinates, the angles.
pub(crate) trait InPlane<const A: usize> {
    /// Returns the position of the cylinder's centre in the plane \[m\].
    fn center(&self) -> V2;
    /// Returns the velocity of the centre [m/s].
    fn velocity(&self) -> V2;
    /// Returns the projection of the axis onto the plane.
    fn axis(&self) -> V2;
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

    fn axis(&self) -> V2 {
        self.R.column(0).xy()
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
    fn axis(&self) -> V2 {
        self.axis
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
