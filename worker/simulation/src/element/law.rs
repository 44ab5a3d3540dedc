//! Force law: force, stiffness, damping, energy and power of an element as functions of its deformations.
//!
//! A law knows neither bodies nor coordinates. Its element maps the coordinates `q` of the machine to `N`
//! deformations `x(q)` (the extension, shear and turn of a joint, the penetration of a contact point), and
//! the law returns the forces `f(x, x')` that resist them. With the Jacobian `J = dx/dq`, the assembly forms
//! the generalised forces `-J^T f`, the stiffness `K = J^T (f_x J + f_x' J') + sum_r f_r d2x_r/dq2` and the
//! damping `D = J^T f_x' J`; the integrator's coefficients enter in the assembly alone.
use crate::math::real::Real;

/// Answer of a force law with `N` deformations, for single numbers or for several elements in SIMD lanes.
#[derive(Clone, Copy, Debug)]
pub struct LawResponse<T, const N: usize> {
    /// Forces that resist the deformations, each in the unit of energy per unit of its deformation.
    pub force: [T; N],
    /// Derivatives of each force (row) with respect to each deformation.
    pub stiffness: [[T; N]; N],
    /// Derivatives of each force (row) with respect to the rate of each deformation.
    pub damping: [[T; N]; N],
    /// Elastic energy stored \[J\].
    pub energy: T,
    /// Power dissipated \[W\]: the power of the forces minus the rate of the stored energy.
    pub dissipated: T,
}

impl<T: Real, const N: usize> LawResponse<T, N> {
    /// Returns the response of a share of the element: every quantity times `share`.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions; what is not used is not computed"
    )]
    #[inline(always)]
    #[must_use]
    pub fn scaled(&self, share: f64) -> Self {
        let mut all = *self;
        for r in 0..N {
            all.force[r] = all.force[r] * share;
            for s in 0..N {
                all.stiffness[r][s] = all.stiffness[r][s] * share;
                all.damping[r][s] = all.damping[r][s] * share;
            }
        }
        all.energy = all.energy * share;
        all.dissipated = all.dissipated * share;
        all
    }
}

/// Law of the forces of an element with `N` deformations and `C` coefficients.
///
/// [`contract`](super) checks every law: stiffness, damping and the derivatives with respect to coefficients
/// against differences, the power balance, and equal bits in SIMD lanes.
pub trait ForceLaw<const N: usize, const C: usize>: Copy {
    /// Returns the coefficients of the law.
    fn coefficients(&self) -> [f64; C];

    /// Returns the law with other coefficients.
    #[must_use]
    fn with_coefficients(&self, coefficients: [f64; C]) -> Self;

    /// Returns forces, derivatives, energy and power at deformations and their rates.
    ///
    /// Implementations are inlined, and what a caller leaves unused is not computed.
    fn response<T: Real>(&self, deformation: [T; N], rate: [T; N]) -> LawResponse<T, N>;

    /// Returns the derivatives of the forces with respect to each coefficient.
    fn by_coefficients<T: Real>(&self, deformation: [T; N], rate: [T; N]) -> [[T; N]; C];
}
