//! Elementary functions that give the same bits on every machine.
//!
//! The C library's `sin`, `pow` and friends differ by one unit in the last place between CPUs with
//! and without fused multiply-add; `libm` is pure Rust and does not. `sqrt` is exact everywhere.

/// Sine and cosine.
#[inline]
pub fn sin_cos(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Angle of the vector `(x, y)` from the x axis, in (-pi, pi].
#[inline]
pub fn atan2(y: f64, x: f64) -> f64 {
    libm::atan2(y, x)
}

/// `e^x`.
#[inline]
pub fn exp(x: f64) -> f64 {
    libm::exp(x)
}

/// Hyperbolic tangent.
#[inline]
pub fn tanh(x: f64) -> f64 {
    libm::tanh(x)
}

/// `base^exponent`.
#[inline]
pub fn powf(base: f64, exponent: f64) -> f64 {
    libm::pow(base, exponent)
}

/// `x^exponent` for a penetration law: the usual exponent 3/2 costs one square root.
#[inline]
pub fn power_law(x: f64, exponent: f64) -> f64 {
    #[expect(clippy::float_cmp, reason = "selects the exact special case")]
    if exponent == 1.5 {
        x * x.sqrt()
    } else {
        powf(x, exponent)
    }
}

#[cfg(test)]
mod tests {
    /// One reduction of the argument serves both, to the bit.
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
