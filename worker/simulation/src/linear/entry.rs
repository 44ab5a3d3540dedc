//! Number types of one unknown: a scalar for one right-hand side, or several SIMD lanes for several
//! right-hand sides at once.
use pulp::Simd;
use std::ops::{Add, AddAssign, Div, Mul, Sub, SubAssign};

/// Number of right-hand sides that are solved simultaneously, one per SIMD lane.
pub const LANES: usize = 4;

/// Values of one unknown for [`LANES`] right-hand sides.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(align(32))]
pub struct Lanes(pub [f64; LANES]);

/// Arithmetic of the value of one unknown; implemented by a scalar (one right-hand side) and by lanes
/// (several), so that code linear in a vector of unknowns serves both.
pub trait MatrixEntry:
    Copy
    + Add<Output = Self>
    + AddAssign
    + SubAssign
    + Sub<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
}

impl MatrixEntry for f64 {}
impl MatrixEntry for Lanes {}

impl Lanes {
    /// Adds `factor` times `x` to the lanes with SIMD instructions; product and sum are rounded separately
    /// (no fused multiply-add).
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn add_scaled<S: Simd>(&mut self, simd: S, x: &Self, factor: f64) {
        let factor = simd.splat_f64s(factor);
        let (x, _) = S::as_simd_f64s(&x.0);
        let (sum, _) = S::as_mut_simd_f64s(&mut self.0);
        for (sum, x) in sum.iter_mut().zip(x) {
            *sum = simd.add_f64s(*sum, simd.mul_f64s(*x, factor));
        }
    }

    /// Subtracts `factor` times `x` from the lanes with SIMD instructions; product and difference are rounded
    /// separately (no fused multiply-add).
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn subtract_scaled<S: Simd>(&mut self, simd: S, x: &Self, factor: f64) {
        // a sign costs no digit
        self.add_scaled(simd, x, -factor);
    }

    /// Returns `factor` times the lanes.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    #[must_use]
    pub fn scaled<S: Simd>(&self, simd: S, factor: f64) -> Self {
        let factor = simd.splat_f64s(factor);
        let mut product = Self::default();
        let (x, _) = S::as_simd_f64s(&self.0);
        let (all, _) = S::as_mut_simd_f64s(&mut product.0);
        for (product, x) in all.iter_mut().zip(x) {
            *product = simd.mul_f64s(*x, factor);
        }
        product
    }
}

impl AddAssign for Lanes {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        for k in 0..LANES {
            self.0[k] += other.0[k];
        }
    }
}

impl SubAssign for Lanes {
    #[inline]
    fn sub_assign(&mut self, other: Self) {
        for k in 0..LANES {
            self.0[k] -= other.0[k];
        }
    }
}

impl Add for Lanes {
    type Output = Self;

    #[inline]
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}

impl Sub for Lanes {
    type Output = Self;

    #[inline]
    fn sub(mut self, other: Self) -> Self {
        self -= other;
        self
    }
}

impl Mul<f64> for Lanes {
    type Output = Self;

    #[inline]
    fn mul(self, factor: f64) -> Self {
        let mut product = self;
        for x in &mut product.0 {
            *x *= factor;
        }
        product
    }
}

impl Div<f64> for Lanes {
    type Output = Self;

    #[inline]
    fn div(self, divisor: f64) -> Self {
        Self(self.0.map(|x| x / divisor))
    }
}
