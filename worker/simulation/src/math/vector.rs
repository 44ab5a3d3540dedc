//! Operations on long vectors, compiled for each set of instructions. Nothing is fused, so that the bits are the
//! same on every processor.
#![expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
use pulp::{Arch, Simd, WithSimd};

/// Adds `factor` times `x` to `y`.
pub fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    Arch::new().dispatch(AddScaled { y, factor, x });
}

/// Arguments of [`add_scaled`].
struct AddScaled<'a> {
    y: &'a mut [f64],
    factor: f64,
    x: &'a [f64],
}

impl WithSimd for AddScaled<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (y, x) in self.y.iter_mut().zip(self.x) {
            *y += self.factor * x;
        }
    }
}

/// Computes `y = x + factor z`.
pub fn set_sum(y: &mut [f64], x: &[f64], factor: f64, z: &[f64]) {
    Arch::new().dispatch(SetSum { y, x, factor, z });
}

/// Arguments of [`set_sum`].
struct SetSum<'a> {
    y: &'a mut [f64],
    x: &'a [f64],
    factor: f64,
    z: &'a [f64],
}

impl WithSimd for SetSum<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for ((y, x), z) in self.y.iter_mut().zip(self.x).zip(self.z) {
            *y = x + self.factor * z;
        }
    }
}
