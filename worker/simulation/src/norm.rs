//! Error norms: tolerances of Newton's method and of the local error of a step.
//!
//! Coordinates that determine measured quantities (beam, rod, suspension, modes) have tight tolerances, the
//! cylinders of a rope loose ones.
use pulp::{Arch, Simd, WithSimd};

/// Tolerance of Newton's method for a cylinder's position \[m\]. `TURN` is that for a cylinder's angle
/// \[rad\], `ANGLE` for the angles of beam and rod \[rad\], `MODAL` for a modal coordinate [kg^1/2 m].
pub(crate) const LENGTH: f64 = 2e-6;
const TURN: f64 = 2e-5;
pub(crate) const ANGLE: f64 = 1e-6;
pub(crate) const MODAL: f64 = 2e-6;

pub(crate) fn square(x: f64) -> f64 {
    x * x
}

/// Returns the larger of `norm` and the absolute value of `x`, or NaN if `x` is NaN.
#[inline]
pub(crate) fn worst(norm: f64, x: f64) -> f64 {
    let x = x.abs();
    if norm < x || x.is_nan() { x } else { norm }
}

/// Returns the larger of `norm` and the largest Newton correction of a cylinder's coordinate, in units of
/// Newton's tolerance.
pub(crate) fn cylinders_newton(norm: f64, change: &[f64], width: usize) -> f64 {
    cylinders(norm, change, width, [LENGTH, TURN])
}

/// Returns the larger of `norm` and the largest local error of a cylinder's coordinate, in units of the error
/// tolerance.
pub(crate) fn cylinders_error(norm: f64, error: &[f64], width: usize) -> f64 {
    cylinders(norm, error, width, [2e-4, 5e-3])
}

/// Returns the larger of `norm` and the scaled maximum norm of the cylinders' coordinates. Of the `width`
/// coordinates of a cylinder, lengths come first: two in the plane, three in space.
fn cylinders(norm: f64, x: &[f64], width: usize, [length, turn]: [f64; 2]) -> f64 {
    let largest = if width == 3 {
        let [x, y, psi] = largest(x);
        [worst(x, y), psi]
    } else {
        let [x, y, z, phi, theta, psi] = largest(x);
        [worst(worst(x, y), z), worst(worst(phi, theta), psi)]
    };
    worst(worst(norm, largest[0] / length), largest[1] / turn)
}

/// Returns the largest absolute value over all cylinders of each of a cylinder's `W` coordinates.
fn largest<const W: usize>(x: &[f64]) -> [f64; W] {
    Arch::new().dispatch(Largest(x))
}

/// Evaluation of [`largest`], compiled for each set of instructions.
struct Largest<'a, const W: usize>(&'a [f64]);

impl<const W: usize> WithSimd for Largest<'_, W> {
    type Output = [f64; W];

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> [f64; W] {
        largest_inlined(self.0)
    }
}

#[inline(always)]
fn largest_inlined<const W: usize>(x: &[f64]) -> [f64; W] {
    // each comparison waits for the one before it: four of them side by side
    const ROWS: usize = 4;
    let mut norms = [[0.0; W]; ROWS];
    let (fours, rest) = x.as_chunks::<W>().0.as_chunks::<ROWS>();
    for four in fours {
        for row in 0..ROWS {
            for k in 0..W {
                norms[row][k] = worst(norms[row][k], four[row][k]);
            }
        }
    }
    let mut all = [0.0; W];
    for x in norms.iter().chain(rest) {
        for k in 0..W {
            all[k] = worst(all[k], x[k]);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the error norm ignores signs and stays NaN once a NaN has entered it.
    #[test]
    fn the_worst_value_is_kept() {
        assert_eq!(worst(1.0, -2.0).to_bits(), 2.0_f64.to_bits());
        assert_eq!(worst(2.0, 1.0).to_bits(), 2.0_f64.to_bits());
        assert_eq!(
            worst(1.0, f64::NEG_INFINITY).to_bits(),
            f64::INFINITY.to_bits()
        );
        assert!(worst(f64::INFINITY, f64::NAN).is_nan());
        assert!(worst(-f64::NAN, f64::INFINITY).is_nan());
        let mut change = [0.0; 12];
        change[4] = f64::NAN;
        change[8] = 1.0;
        assert!(cylinders_newton(0.0, &change, 3).is_nan());
        assert!(cylinders_error(0.0, &change, 6).is_nan());
    }
}
