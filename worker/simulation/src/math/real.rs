//! Arithmetic that is written once for a single number and for several numbers side by side in SIMD lanes.
//!
//! Lanes are independent, nothing is fused, and a comparison selects between computed values, so that every
//! lane has the bits of the single number, whatever the width of the processor's vectors.
#![expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
use pulp::Simd;
use std::fmt::Debug;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Number of lanes of the widest vector of any instruction set in use, to which arrays are padded.
pub const WIDEST: usize = 4;

/// Real number, or several real numbers in SIMD lanes.
///
/// Constants enter as `f64` operands, which apply to every lane.
pub trait Real:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
{
    /// Returns the constant `x` in every lane.
    #[must_use]
    fn constant(self, x: f64) -> Self;

    /// Returns the square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;

    /// Returns `below` where `self < bound`, otherwise `above` (also where either is not a number).
    #[must_use]
    fn select_less(self, bound: Self, below: Self, above: Self) -> Self;

    /// Applies a function of single numbers to every lane, one after the other, and returns its results.
    #[must_use]
    fn each<const K: usize>(self, function: impl Fn(f64) -> [f64; K]) -> [Self; K];

    /// Returns the smaller of two numbers, `other` where `self` is not a number.
    #[must_use]
    #[inline(always)]
    fn at_most(self, other: Self) -> Self {
        self.select_less(other, self, other)
    }

    /// Returns the larger of two numbers, `other` where `self` is not a number.
    #[must_use]
    #[inline(always)]
    fn at_least(self, other: Self) -> Self {
        other.select_less(self, self, other)
    }
}

impl Real for f64 {
    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        x
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::sqrt(self)
    }

    #[inline(always)]
    fn select_less(self, bound: Self, below: Self, above: Self) -> Self {
        if self < bound { below } else { above }
    }

    #[inline(always)]
    fn each<const K: usize>(self, function: impl Fn(Self) -> [Self; K]) -> [Self; K] {
        function(self)
    }
}

/// Vector of the widest kind that the instruction set `S` has.
#[derive(Clone, Copy, Debug)]
pub struct Vector<S: Simd> {
    simd: S,
    lanes: S::f64s,
}

impl<S: Simd> Vector<S> {
    /// Returns the constant `x` in every lane.
    #[inline(always)]
    pub fn splat(simd: S, x: f64) -> Self {
        Self {
            simd,
            lanes: simd.splat_f64s(x),
        }
    }

    /// Wraps the lanes of a vector.
    #[inline(always)]
    pub const fn new(simd: S, lanes: S::f64s) -> Self {
        Self { simd, lanes }
    }

    /// Returns the lanes of the vector.
    #[inline(always)]
    pub const fn lanes(self) -> S::f64s {
        self.lanes
    }

    /// Returns the vector of the first elements of an array.
    #[inline(always)]
    pub fn from_array(simd: S, array: &[f64; WIDEST]) -> Self {
        Self::new(simd, S::as_simd_f64s(array).0[0])
    }

    /// Returns the lanes as the first elements of an array, whose rest is zero.
    #[inline(always)]
    pub fn to_array(self) -> [f64; WIDEST] {
        let mut array = [0.0; WIDEST];
        S::as_mut_simd_f64s(&mut array).0[0] = self.lanes;
        array
    }
}

macro_rules! operator {
    ($trait:ident, $method:ident, $simd:ident) => {
        impl<S: Simd> $trait for Vector<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self::new(self.simd, self.simd.$simd(self.lanes, other.lanes))
            }
        }

        impl<S: Simd> $trait<f64> for Vector<S> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                $trait::$method(self, Self::splat(self.simd, other))
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Vector<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self::new(self.simd, self.simd.neg_f64s(self.lanes))
    }
}

impl<S: Simd> Real for Vector<S> {
    #[inline(always)]
    fn constant(self, x: f64) -> Self {
        Self::splat(self.simd, x)
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self::new(self.simd, self.simd.sqrt_f64s(self.lanes))
    }

    #[inline(always)]
    fn select_less(self, bound: Self, below: Self, above: Self) -> Self {
        let mask = self.simd.less_than_f64s(self.lanes, bound.lanes);
        let lanes = self.simd.select_f64s(mask, below.lanes, above.lanes);
        Self::new(self.simd, lanes)
    }

    #[inline(always)]
    fn each<const K: usize>(self, function: impl Fn(f64) -> [f64; K]) -> [Self; K] {
        let arguments = self.to_array();
        let mut results = [[0.0; WIDEST]; K];
        for (lane, x) in arguments[..S::F64_LANES].iter().enumerate() {
            for (results, y) in results.iter_mut().zip(function(*x)) {
                results[lane] = y;
            }
        }
        results.map(|results| Self::from_array(self.simd, &results))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, Scalar, WithSimd};

    /// Test computation with every operation of [`Real`].
    fn all<T: Real>(x: T, y: T) -> T {
        let root = (x * x + 2.0).sqrt();
        let chosen = x.select_less(y, root / y, -root);
        chosen.at_least(x) - chosen.at_most(y) * 0.3 + x.each(|x| [x.abs() + 1.0])[0]
            - y.constant(1.7)
    }

    /// Evaluation of [`all`] on arrays, run for each SIMD width.
    struct Work<'a>([&'a [f64]; 2]);

    impl WithSimd for Work<'_> {
        type Output = Vec<u64>;

        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let [x, y] = self.0.map(|x| S::as_simd_f64s(x).0);
            let mut out = vec![0.0; self.0[0].len()];
            let (sums, _) = S::as_mut_simd_f64s(&mut out);
            for ((sum, x), y) in sums.iter_mut().zip(x).zip(y) {
                *sum = all(Vector::new(simd, *x), Vector::new(simd, *y)).lanes();
            }
            out.iter().map(|x| x.to_bits()).collect()
        }
    }

    /// Checks that lanes of every width have the bits of single numbers, also where these are infinite or no
    /// numbers.
    #[test]
    fn lanes_have_the_bits_of_single_numbers() {
        let mut x: Vec<f64> = (0..61).map(|k| f64::from(k * k % 17) - 7.3).collect();
        x.extend([f64::INFINITY, -0.0, 1e300]);
        let mut y: Vec<f64> = (0..61).map(|k| f64::from(k * 5 % 13) - 4.1).collect();
        y.extend([2.0, f64::NEG_INFINITY, -1e-300]);
        let single: Vec<u64> = x
            .iter()
            .zip(&y)
            .map(|(x, y)| all(*x, *y).to_bits())
            .collect();
        assert_eq!(Work([&x, &y]).with_simd(Scalar), single);
        assert_eq!(Arch::new().dispatch(Work([&x, &y])), single);
    }
}
