//! Six-component bushing between marker I and marker J (paper, Eqs. 1 and 2; the case reader implements its
//! Eq. 3, the stiffness of a joint from the rope's material).
//!
//! In the frame of J with x along its axis `e`, the force and torque on I are `F = -K R - C V + F_0`, `T = -K
//! Theta - C w` with `K_22 = K_33` and `K_55 = K_66`. Eq. 1 prints `K` without the minus sign that `C` has: a
//! spring of that sign would drive its ends apart, so this is taken for a misprint and corrected here.
//! Because of the isotropy across the axis, only `e` is needed of J's frame, and the law can be written in
//! world axes:
//!
//! `F_I = -[k2 d + c2 V + e (f0 + (k1 - k2) e.d + (c1 - c2) e.V)]`, `d = r_I - r_J`, `V = v_I - v_J - w_J x
//! d`, and the same for the torque with the rotation vector `Theta` and `w = w_I - w_J`. On J acts `F_J =
//! -F_I`, `T_J = -T_I - d x F_I` (Eq. 2). Of Eq. 1's six preloads only the tension `f0` along the axis is
//! kept: preloads in shear and bending need a preferred direction across the rope, which has none, and a
//! torque would turn cylinders out of the plane of a single rope, where nothing holds them (two ropes of
//! opposite lay balance it).
use super::law::{ForceLaw, LawResponse};
use super::plane::DEFORMATIONS;
use crate::math::real::Real;
use crate::math::rotation::{inverse_left_jacobian, rotation_vector, skew};
use nalgebra::{Matrix3, Vector3};

type V3 = Vector3<f64>;
type M3 = Matrix3<f64>;

/// Coefficients of a transversely isotropic bushing, in SI units with angles in radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bushing {
    /// Axial and shear stiffness `K_11`, `K_22 = K_33` [N/m].
    pub stiffness: [f64; 2],
    /// Axial and shear damping `C_11`, `C_22 = C_33` [N s/m].
    pub damping: [f64; 2],
    /// Torsional and bending stiffness `K_44`, `K_55 = K_66` [N m/rad].
    pub rotational_stiffness: [f64; 2],
    /// Torsional and bending damping `C_44`, `C_55 = C_66` [N m s/rad].
    pub rotational_damping: [f64; 2],
    /// Axial preload: the tension at zero extension, positive where it draws the markers together \[N\].
    pub preload: f64,
}

/// Marker: a frame fixed on a body, with the motion of that body.
#[derive(Clone, Copy, Debug)]
pub struct Marker {
    /// Position of the body's reference point in the world frame W \[m\].
    pub p: V3,
    /// Vector from the body's reference point to the marker, in the world frame W \[m\].
    pub rho: V3,
    /// Velocity of the body's reference point [m/s].
    pub v: V3,
    /// Angular velocity of the body, in the world frame W [rad/s].
    pub w: V3,
    /// Orientation of the marker: rotation matrix whose columns are the marker's axes in the world frame W.
    pub R: M3,
}

impl Marker {
    fn position(&self) -> V3 {
        self.p + self.rho
    }

    fn velocity(&self) -> V3 {
        self.v + self.w.cross(&self.rho)
    }
}

/// Force and torques that a joint exerts on its two bodies I and J, in the world frame W; torques are about
/// the bodies' reference points.
#[derive(Clone, Copy, Debug)]
pub struct LinkLoad {
    /// Force on body I \[N\]; the opposite force acts on body J.
    pub force: V3,
    /// Torque on body I about its reference point [N m].
    pub torque_i: V3,
    /// Torque on body J about its reference point [N m].
    pub torque_j: V3,
    /// Component of the joint force along the axis of marker J; negative where the joint pulls \[N\].
    pub axial: f64,
    /// Power dissipated by the joint's damping \[W\].
    pub dissipated: f64,
}

impl LinkLoad {
    /// Returns a joint load with zero force and torques.
    pub fn none() -> Self {
        Self {
            force: V3::zeros(),
            torque_i: V3::zeros(),
            torque_j: V3::zeros(),
            axial: 0.0,
            dissipated: 0.0,
        }
    }
}

/// Additional tension in a joint along the axis of marker J, on top of the bushing's force.
#[derive(Clone, Copy, Debug)]
pub struct AxialTension {
    /// Additional tension, positive where it draws the markers together \[N\].
    pub force: f64,
    /// Power dissipated by the additional tension \[W\].
    pub dissipated: f64,
    /// Derivative of the additional tension with respect to the joint's extension [N/m].
    pub by_extension: f64,
    /// Derivative of the additional tension with respect to the rate of extension [N s/m].
    pub by_rate: f64,
}

/// Derivatives of a joint's force and torques ([`LinkLoad`]) with respect to the motion of one of its bodies.
///
/// Each field holds three matrices: for the force, the torque on I and the torque on J. The fields
/// differentiate with respect to displacement `p`, velocity `v`, rotation `a` and angular velocity `w` of the
/// body, all in the world frame W.
#[derive(Clone, Copy, Debug)]
pub struct LinkTangent {
    /// Derivatives with respect to the displacement of the body's reference point.
    pub p: [M3; 3],
    /// Derivatives with respect to the velocity of the body's reference point.
    pub v: [M3; 3],
    /// Derivatives with respect to a rotation of the body.
    pub a: [M3; 3],
    /// Derivatives with respect to the angular velocity of the body.
    pub w: [M3; 3],
}

/// Motion of marker I relative to marker J (position, velocity, rotation, angular velocity), used by both
/// load and tangent.
struct Deformation {
    e: V3,
    d: V3,
    V: V3,
    theta: V3,
    w: V3,
}

impl Bushing {
    /// Returns the bushing with every stiffness and damping multiplied by `factor`, under the same preload.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            stiffness: self.stiffness.map(|x| x * factor),
            damping: self.damping.map(|x| x * factor),
            rotational_stiffness: self.rotational_stiffness.map(|x| x * factor),
            rotational_damping: self.rotational_damping.map(|x| x * factor),
            preload: self.preload,
        }
    }

    /// Returns the bushing's static tension at an extension along its axis \[N\].
    pub fn tension_at(&self, extension: f64) -> f64 {
        extension * self.stiffness[0] + self.preload
    }

    /// Returns the bushing's static extension under a tension along its axis \[m\].
    pub fn extension_under(&self, tension: f64) -> f64 {
        (tension - self.preload) / self.stiffness[0]
    }

    /// Returns a revolute joint with this bushing's axial coefficients: equally stiff in every direction,
    /// free to rotate.
    #[must_use]
    pub fn revolute(&self) -> Self {
        Self {
            stiffness: [self.stiffness[0]; 2],
            damping: [self.damping[0]; 2],
            rotational_stiffness: [0.0; 2],
            rotational_damping: [0.0; 2],
            preload: self.preload,
        }
    }

    /// Returns a pin joint with this bushing's axial coefficients, for markers whose axes are the pin's:
    /// equally stiff in every direction, free to rotate about the axis, and with the bending stiffness about
    /// the other axes.
    #[must_use]
    pub fn pinned(&self) -> Self {
        Self {
            rotational_stiffness: [0.0, self.rotational_stiffness[1]],
            rotational_damping: [0.0, self.rotational_damping[1]],
            ..self.revolute()
        }
    }

    /// Returns whether every coefficient and the preload are zero.
    pub(crate) fn is_zero(&self) -> bool {
        *self
            == Self {
                preload: 0.0,
                ..self.scaled(0.0)
            }
    }

    fn turns(&self) -> bool {
        let of = self
            .rotational_stiffness
            .iter()
            .chain(&self.rotational_damping);
        of.fold(0.0, |sum, x| sum + x) > 0.0
    }

    #[inline]
    fn deformation(&self, i: &Marker, j: &Marker) -> Deformation {
        let d = i.position() - j.position();
        Deformation {
            e: j.R.column(0).into_owned(),
            d,
            V: i.velocity() - j.velocity() - j.w.cross(&d),
            theta: if self.turns() {
                rotation_vector(&i.R, &j.R)
            } else {
                V3::zeros()
            },
            w: i.w - j.w,
        }
    }

    /// Computes the joint's force and torques from the motion of its markers I and J.
    #[inline]
    pub fn load(&self, i: &Marker, j: &Marker) -> LinkLoad {
        let [k1, k2] = self.stiffness;
        let [c1, c2] = self.damping;
        let [k4, k5] = self.rotational_stiffness;
        let [c4, c5] = self.rotational_damping;
        let Deformation { e, d, V, theta, w } = self.deformation(i, j);
        let damping = V * c2 + e * ((c1 - c2) * e.dot(&V));
        let force = -(d * k2 + e * ((k1 - k2) * e.dot(&d) + self.preload) + damping);
        let bending_damping = w * c5 + e * ((c4 - c5) * e.dot(&w));
        let torque = -(theta * k5 + e * ((k4 - k5) * e.dot(&theta)) + bending_damping);
        LinkLoad {
            force,
            torque_i: torque + i.rho.cross(&force),
            torque_j: -torque - (d + j.rho).cross(&force),
            axial: e.dot(&force),
            dissipated: damping.dot(&V) + bending_damping.dot(&w),
        }
    }

    /// Computes the extension of the joint along its axis \[m\] and its rate [m/s].
    pub fn extension(&self, i: &Marker, j: &Marker) -> [f64; 2] {
        let Deformation { e, d, V, .. } = self.deformation(i, j);
        [e.dot(&d), e.dot(&V)]
    }

    /// Adds the force and torques of an additional axial tension to a joint's load.
    pub fn add_pull(&self, (i, j): (&Marker, &Marker), pull: &AxialTension, load: &mut LinkLoad) {
        let Deformation { e, d, .. } = self.deformation(i, j);
        let force = e * -pull.force;
        load.force += force;
        load.torque_i += i.rho.cross(&force);
        load.torque_j -= (d + j.rho).cross(&force);
        load.axial -= pull.force;
        load.dissipated += pull.dissipated;
    }

    /// Computes the elastic energy stored in the joint \[J\]; exact if torsion and bending do not mix (planar
    /// motion).
    pub fn energy(&self, i: &Marker, j: &Marker) -> f64 {
        let [k1, k2] = self.stiffness;
        let [k4, k5] = self.rotational_stiffness;
        let Deformation { e, d, theta, .. } = self.deformation(i, j);
        let (axial, twist) = (e.dot(&d), e.dot(&theta));
        self.preload * axial
            + 0.5 * (k2 * d.norm_squared() + (k1 - k2) * axial * axial)
            + 0.5 * (k5 * theta.norm_squared() + (k4 - k5) * twist * twist)
    }

    /// Computes the derivatives of [`Self::load`] with respect to the motion of bodies I and J.
    pub fn tangent(&self, i: &Marker, j: &Marker, load: &LinkLoad) -> [LinkTangent; 2] {
        self.tangent_with(i, j, load, None)
    }

    /// Computes the derivatives of a joint's load with respect to the motion of bodies I and J, including an
    /// additional tension that `load` already contains.
    pub fn tangent_with(
        &self,
        i: &Marker,
        j: &Marker,
        load: &LinkLoad,
        further: Option<&AxialTension>,
    ) -> [LinkTangent; 2] {
        let [mut k1, k2] = self.stiffness;
        let [mut c1, c2] = self.damping;
        let [k4, k5] = self.rotational_stiffness;
        let [c4, c5] = self.rotational_damping;
        let Deformation { e, d, V, theta, w } = self.deformation(i, j);
        let mut pull = self.preload + (k1 - k2) * e.dot(&d) + (c1 - c2) * e.dot(&V);
        if let Some(further) = further {
            pull += further.force;
            k1 += further.by_extension;
            c1 += further.by_rate;
        }
        let ee = e * e.transpose();
        let K = M3::from_diagonal_element(k2) + ee * (k1 - k2);
        let C = M3::from_diagonal_element(c2) + ee * (c1 - c2);
        let G = M3::from_diagonal_element(pull) + e * (d * (k1 - k2) + V * (c1 - c2)).transpose();
        let (skew_e, rho_i, rho_j) = (skew(&e), skew(&i.rho), skew(&j.rho));
        let relative = skew(&i.w) - skew(&j.w);
        let by_position = C * skew(&j.w) - K;
        let force_i = [by_position, -C, K * rho_i + C * relative * rho_i, C * rho_i];
        let arm = skew(&(d + j.rho));
        let force_j = [-by_position, C, G * skew_e - K * rho_j, -(C * arm)];

        let (torque_a_i, torque_w, torque_a_j) = if self.turns() {
            let Kr = M3::from_diagonal_element(k5) + ee * (k4 - k5);
            let Cr = M3::from_diagonal_element(c5) + ee * (c4 - c5);
            let twist = (k4 - k5) * e.dot(&theta) + (c4 - c5) * e.dot(&w);
            let Gr = M3::from_diagonal_element(twist)
                + e * (theta * (k4 - k5) + w * (c4 - c5)).transpose();
            let J = inverse_left_jacobian(&theta);
            (-(Kr * J), Cr, Kr * J.transpose() + Gr * skew_e)
        } else {
            (M3::zeros(), M3::zeros(), M3::zeros())
        };

        let F = skew(&load.force);
        let F_rho = F * rho_i;
        // torque on I = T + rho_I x F; torque on J = -T - (r_I - p_J) x F
        let tangent_i = LinkTangent {
            p: [force_i[0], rho_i * force_i[0], F - arm * force_i[0]],
            v: [force_i[1], rho_i * force_i[1], -(arm * force_i[1])],
            a: [
                force_i[2],
                torque_a_i + F_rho + rho_i * force_i[2],
                -torque_a_i - F_rho - arm * force_i[2],
            ],
            w: [
                force_i[3],
                rho_i * force_i[3] - torque_w,
                torque_w - arm * force_i[3],
            ],
        };
        let tangent_j = LinkTangent {
            p: [force_j[0], rho_i * force_j[0], -F - arm * force_j[0]],
            v: [force_j[1], rho_i * force_j[1], -(arm * force_j[1])],
            a: [
                force_j[2],
                torque_a_j + rho_i * force_j[2],
                -torque_a_j - arm * force_j[2],
            ],
            w: [
                force_j[3],
                rho_i * force_j[3] + torque_w,
                -torque_w - arm * force_j[3],
            ],
        };
        [tangent_i, tangent_j]
    }
}

/// Number of coefficients of a bushing in the plane: three stiffnesses, three damping coefficients, preload.
pub const PLANE_COEFFICIENTS: usize = 7;
/// Index of the preload (tension along the axis) among the coefficients of a bushing in the plane.
pub const PRELOAD_INDEX: usize = 6;

/// Law of extension, shear and bending in the plane, with the coefficients `K_11`, `K_22`, `K_55`, `C_11`,
/// `C_22`, `C_55` and the preload; torsion does not occur.
impl ForceLaw<DEFORMATIONS, PLANE_COEFFICIENTS> for Bushing {
    fn coefficients(&self) -> [f64; PLANE_COEFFICIENTS] {
        let ([k1, k2], [c1, c2]) = (self.stiffness, self.damping);
        let [[_, k5], [_, c5]] = [self.rotational_stiffness, self.rotational_damping];
        [k1, k2, k5, c1, c2, c5, self.preload]
    }

    fn with_coefficients(&self, of: [f64; PLANE_COEFFICIENTS]) -> Self {
        let [k1, k2, k5, c1, c2, c5, preload] = of;
        Self {
            stiffness: [k1, k2],
            damping: [c1, c2],
            rotational_stiffness: [self.rotational_stiffness[0], k5],
            rotational_damping: [self.rotational_damping[0], c5],
            preload,
        }
    }

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn response<T: Real>(&self, x: [T; 3], rate: [T; 3]) -> LawResponse<T, 3> {
        let [k1, k2, k5, c1, c2, c5, preload] = self.coefficients();
        let zero = x[0].constant(0.0);
        let diagonal = |[a, b, c]: [f64; 3]| {
            [
                [zero.constant(a), zero, zero],
                [zero, zero.constant(b), zero],
                [zero, zero, zero.constant(c)],
            ]
        };
        let viscous = [rate[0] * c1, rate[1] * c2, rate[2] * c5];
        let elastic = [x[0] * k1, x[1] * k2, x[2] * k5];
        LawResponse {
            force: [
                elastic[0] + viscous[0] + preload,
                elastic[1] + viscous[1],
                elastic[2] + viscous[2],
            ],
            stiffness: diagonal([k1, k2, k5]),
            damping: diagonal([c1, c2, c5]),
            energy: (elastic[0] * x[0] + elastic[1] * x[1] + elastic[2] * x[2]) * 0.5
                + x[0] * preload,
            dissipated: viscous[0] * rate[0] + viscous[1] * rate[1] + viscous[2] * rate[2],
        }
    }

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn by_coefficients<T: Real>(&self, x: [T; 3], rate: [T; 3]) -> [[T; 3]; PLANE_COEFFICIENTS] {
        let zero = x[0].constant(0.0);
        [
            [x[0], zero, zero],
            [zero, x[1], zero],
            [zero, zero, x[2]],
            [rate[0], zero, zero],
            [zero, rate[1], zero],
            [zero, zero, rate[2]],
            [zero.constant(1.0), zero, zero],
        ]
    }
}
