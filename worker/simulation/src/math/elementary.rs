//! Elementary functions with bitwise equal results on every machine.
//!
//! The C library's `sin`, `pow` and related functions differ by one unit in the last place between CPUs with
//! and without fused multiply-add; `libm` is pure Rust and does not. `sqrt` is correctly rounded everywhere.

/// Returns sine and cosine of an angle \[rad\].
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Computes sines and cosines of many angles \[rad\], equal to those of [`sin_cos`] to the last bit or two,
/// and to 1e-24 near their zeros.
///
/// A single loop without branches, which compilers vectorise: the angle is reduced by the nearest multiple of
/// a quarter turn, in two pieces (Cody and Waite), and the polynomials of fdlibm's kernels are evaluated. If
/// any angle exceeds 1e4 rad, all are computed one by one.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub fn sin_cos_all(angles: &[f64], sines: &mut [f64], cosines: &mut [f64]) {
    let n = angles.len();
    let (sines, cosines) = (&mut sines[..n], &mut cosines[..n]);
    // not a number fails the comparison too; all are compared, so that this loop is vectorised as well
    if !angles.iter().fold(true, |near, x| near & (x.abs() < FAR)) {
        for i in 0..n {
            (sines[i], cosines[i]) = sin_cos(angles[i]);
        }
        return;
    }
    for i in 0..n {
        let x = angles[i];
        // adding and taking away 1.5 2^52 rounds to an integer, whose last bits stand in the sum's
        let shifted = x * QUARTERS + ROUND;
        let quarters = shifted - ROUND;
        let bits = shifted.to_bits();
        let coarse = x - quarters * QUARTER;
        let left = quarters * QUARTER_REST;
        let r = coarse - left;
        let rest = (coarse - r) - left;
        let z = r * r;
        let tail = S2 + z * (S3 + z * (S4 + z * (S5 + z * S6)));
        let cubic = z * r;
        let sine = r - ((z * (0.5 * rest - cubic * tail) - rest) - cubic * S1);
        let series = z * (C1 + z * (C2 + z * (C3 + z * (C4 + z * (C5 + z * C6)))));
        let half = 0.5 * z;
        let w = 1.0 - half;
        let cosine = w + (((1.0 - w) - half) + (z * series - r * rest));
        let odd = bits & 1 == 1;
        let (s, c) = if odd { (cosine, sine) } else { (sine, cosine) };
        sines[i] = f64::from_bits(s.to_bits() ^ ((bits & 2) << 62));
        cosines[i] = f64::from_bits(c.to_bits() ^ ((bits.wrapping_add(1) & 2) << 62));
    }
}

const FAR: f64 = 1e4;
const ROUND: f64 = 6_755_399_441_055_744.0;
const QUARTERS: f64 = std::f64::consts::FRAC_2_PI;
/// Leading 33 bits of a quarter turn [pi/2 rad], as in fdlibm; `QUARTER_REST` is the remainder.
const QUARTER: f64 = 1.570_796_326_734_125_6;
const QUARTER_REST: f64 = 6.077_100_506_506_192e-11;
/// Coefficients of fdlibm's kernels for sine (S) and cosine (C) up to an eighth of a turn.
const S1: f64 = -1.666_666_666_666_663_2e-1;
const S2: f64 = 8.333_333_333_322_49e-3;
const S3: f64 = -1.984_126_982_985_795e-4;
const S4: f64 = 2.755_731_370_707_007e-6;
const S5: f64 = -2.505_076_025_340_686_4e-8;
const S6: f64 = 1.589_690_995_211_55e-10;
const C1: f64 = 4.166_666_666_666_66e-2;
const C2: f64 = -1.388_888_888_887_411e-3;
const C3: f64 = 2.480_158_728_947_673e-5;
const C4: f64 = -2.755_731_435_139_066_3e-7;
const C5: f64 = 2.087_572_321_298_175e-9;
const C6: f64 = -1.135_964_755_778_819_5e-11;

/// Returns the angle of the vector `(x, y)` from the x axis, in (-pi, pi].
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// Returns `e^x`.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Returns the hyperbolic tangent.
#[inline]
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}

/// Returns `base^exponent`.
#[inline]
pub fn powf(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

#[cfg(test)]
mod tests {
    /// Checks that the vectorised sines and cosines agree with single evaluations in all quadrants, at their
    /// borders, and for angles too large for the loop.
    #[test]
    fn many_sines_and_cosines_agree_with_single_ones() {
        let mut angles: Vec<f64> = (-40_000..40_000).map(|k| f64::from(k) * 7.3e-4).collect();
        for k in -9..9 {
            let border = f64::from(k) * std::f64::consts::FRAC_PI_4;
            angles.extend([border, border.next_up(), border.next_down(), border + 1e-9]);
        }
        let compare = |angles: &[f64]| {
            let (mut s, mut c) = (vec![0.0; angles.len()], vec![0.0; angles.len()]);
            super::sin_cos_all(angles, &mut s, &mut c);
            for ((x, s), c) in angles.iter().zip(s).zip(c) {
                let (sine, cosine) = super::sin_cos(*x);
                // where a value vanishes, what two pieces of a quarter turn leave out remains
                let close = |a: f64, b: f64| (a - b).abs() <= 2.3e-16 * b.abs() + 1e-24;
                assert!(
                    close(s, sine) && close(c, cosine),
                    "{x}: {s} {sine}, {c} {cosine}"
                );
            }
        };
        compare(&angles);
        angles.push(1e7);
        compare(&angles);
        let (mut s, mut c) = ([0.0; 2], [0.0; 2]);
        super::sin_cos_all(&[f64::NAN, 0.0], &mut s, &mut c);
        assert!(s[0].is_nan() && c[0].is_nan());
        assert_eq!([s[1], c[1]].map(f64::to_bits), [0.0, 1.0].map(f64::to_bits));
    }

    /// Checks that [`sin_cos`] equals libm's separate sine and cosine bitwise.
    #[test]
    fn sine_and_cosine_are_those_of_libm() {
        for k in -40_000..40_000 {
            let x = f64::from(k) * 7.3e-4 * (1.0 + f64::from(k % 7));
            let (s, c) = super::sin_cos(x);
            let apart = [libm::sin(x), libm::cos(x)];
            assert_eq!([s, c].map(f64::to_bits), apart.map(f64::to_bits), "{x}");
        }
    }
}
