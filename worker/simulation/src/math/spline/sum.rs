//! Weighted sum of splines on one grid, evaluated as a single spline.
//!
//! If the same weights apply at many positions, the curves are summed once at each grid point (knot), and
//! each position costs the evaluation of one curve. The adjoint works likewise: forces at positions are
//! distributed to the knots, and the generalised force on each curve is gathered from the knots at the end.
use super::{SplinePosition, Splines, ValueAndDerivatives};
use crate::math::real::Real;

/// Two sums of the curves of [`Splines`], evaluated like single splines: weighted with the weights, and with
/// the weights' time derivatives.
#[derive(Clone, Debug, Default)]
pub struct WeightedSplines {
    /// Values at each knot: value and scaled second derivative of the sum with the weights, then of the sum
    /// with the weights' time derivatives. One knot of zeros precedes the first and follows the last.
    knots: Vec<[f64; 4]>,
}

/// Forces at positions on a spline grid, distributed to its knots: sums weighted for the value and for the
/// scaled second derivative at each knot.
#[derive(Clone, Debug, Default)]
pub struct KnotForces {
    /// One knot without meaning precedes the first and follows the last.
    knots: Vec<[f64; 2]>,
}

/// Number of values of [`WeightedSplines::around`].
pub const KNOTS: usize = 12;

/// Both sums of [`WeightedSplines`] around one interval of the grid, valid in this interval and in its two
/// neighbours: there, a cubic spline differs from the interval's cubic by the third power of the distance from
/// the knot between, times the difference of the third coefficients.
///
/// The abscissa counts grid intervals from the left knot of the interval.
#[derive(Clone, Copy, Debug)]
pub struct LocalCubic<T>([CubicPieces<T>; 2]);

/// Coefficients 0 to 3 of a cubic, and the differences of the third coefficient in the next interval and in the
/// one before.
#[derive(Clone, Copy, Debug)]
struct CubicPieces<T> {
    coefficients: [T; 4],
    next: T,
    before: T,
}

impl<T: Real> CubicPieces<T> {
    /// Computes the coefficients from values at the interval's knots, and scaled second derivatives there and
    /// at the knots before and after them.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn new([y0, y1, before, m0, m1, next]: [T; 6]) -> Self {
        let third = m1 - m0;
        Self {
            coefficients: [y0, y1 - y0 - m0 * 3.0 - third, m0 * 3.0, third],
            next: next - m1 - third,
            before: m0 - before - third,
        }
    }
}

impl<T: Real> LocalCubic<T> {
    /// Computes the coefficients from the values of [`WeightedSplines::around`].
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn new(knots: [T; KNOTS]) -> Self {
        let [a, b, c, d, e, f, g, h, i, j, k, l] = knots;
        Self([
            CubicPieces::new([a, b, c, d, e, f]),
            CubicPieces::new([g, h, i, j, k, l]),
        ])
    }

    /// Returns value and derivative by the abscissa of the first sum, and value of the second sum.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn at(&self, t: T) -> [T; 3] {
        let [sum, moving] = &self.0;
        let zero = t.constant(0.0);
        // distance beyond the interval's ends, negative before it
        let beyond = (t - 1.0).at_least(zero) + t.at_most(zero);
        let square = beyond * beyond;
        let [a0, a1, a2, a3] = sum.coefficients;
        let [b0, b1, b2, b3] = moving.coefficients;
        let a_beyond = t.select_less(zero, sum.before, sum.next) * square;
        let b_beyond = t.select_less(zero, moving.before, moving.next) * square;
        [
            ((a3 * t + a2) * t + a1) * t + a0 + a_beyond * beyond,
            (a3 * t * 3.0 + a2 * 2.0) * t + a1 + a_beyond * 3.0,
            ((b3 * t + b2) * t + b1) * t + b0 + b_beyond * beyond,
        ]
    }
}

/// Sums of forces at several positions around one interval of a grid, weighted with the powers 0 to 3 of the
/// position, and with the third power of the distance beyond the right end and before the left end.
pub type ForceMoments<T> = [T; FORCE_MOMENTS];
/// Number of [`ForceMoments`].
pub const FORCE_MOMENTS: usize = 6;

/// Returns the contribution of a force at the position `t` to the [`ForceMoments`].
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub fn force_moments<T: Real>(t: T, force: T) -> ForceMoments<T> {
    let zero = t.constant(0.0);
    let (behind, before) = ((t - 1.0).at_least(zero), t.at_most(zero));
    let first = force * t;
    let second = first * t;
    [
        force,
        first,
        second,
        second * t,
        force * behind * behind * behind,
        force * before * before * before,
    ]
}

impl WeightedSplines {
    /// Computes the two sums of the curves, with `weights` and with their time derivatives `rates`; both hold
    /// one number per curve.
    pub fn assemble(&mut self, splines: &Splines, weights: &[f64], rates: &[f64]) {
        let points = splines.points();
        self.knots.resize(points + 2, [0.0; 4]);
        let curves = splines.knots.chunks_exact(splines.curves.max(1));
        for (sum, knots) in self.knots[1..=points].iter_mut().zip(curves) {
            let (mut at, mut moving) = ([0.0; 2], [0.0; 2]);
            for ((knot, weight), rate) in knots.iter().zip(weights).zip(rates) {
                for k in 0..2 {
                    at[k] += weight * knot[k];
                    moving[k] += rate * knot[k];
                }
            }
            *sum = [at[0], at[1], moving[0], moving[1]];
        }
    }

    /// Returns value and derivatives of the sum with the weights at a grid position, and the value of the sum
    /// with the weights' time derivatives.
    #[inline]
    pub fn at(&self, splines: &Splines, place: &SplinePosition) -> (ValueAndDerivatives, f64) {
        let [y0, m0, dy0, dm0] = self.knots[place.left + 1];
        let [y1, m1, dy1, dm1] = self.knots[place.right + 1];
        let [a, b, cubic_a, cubic_b] = place.weights();
        let value = a * y0 + b * y1 + cubic_a * m0 + cubic_b * m1;
        let rate = a * dy0 + b * dy1 + cubic_a * dm0 + cubic_b * dm1;
        if place.clamped {
            let constant = ValueAndDerivatives {
                value,
                ..ValueAndDerivatives::default()
            };
            return (constant, rate);
        }
        let per_step = splines.per_step;
        let slope = y1 - y0 + (1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1;
        let jet = ValueAndDerivatives {
            value,
            first: slope * per_step,
            second: 6.0 * (a * m0 + b * m1) * (per_step * per_step),
        };
        (jet, rate)
    }

    /// Returns what [`LocalCubic`] needs around the grid interval with the given left knot, for each sum: values
    /// at the interval's two knots, and scaled second derivatives at the knot before, at these two, and at the
    /// knot after them. The interval must not be the last one's successor; beyond the grid the values are zero.
    #[inline]
    pub fn around(&self, left: usize) -> [f64; KNOTS] {
        let [before, at, right, next] = &self.knots[left..left + 4] else {
            return [0.0; KNOTS];
        };
        [
            at[0], right[0], before[1], at[1], right[1], next[1], at[2], right[2], before[3],
            at[3], right[3], next[3],
        ]
    }
}

impl KnotForces {
    /// Sets all forces to zero and resizes to the grid of `splines`.
    pub fn clear(&mut self, splines: &Splines) {
        self.knots.clear();
        self.knots.resize(splines.points() + 2, [0.0; 2]);
    }

    /// Distributes `force` at a grid position to the neighbouring knots.
    #[inline]
    pub fn add(&mut self, place: &SplinePosition, force: f64) {
        let [a, b, cubic_a, cubic_b] = place.weights();
        let [value, bend] = &mut self.knots[place.left + 1];
        *value += force * a;
        *bend += force * cubic_a;
        let [value, bend] = &mut self.knots[place.right + 1];
        *value += force * b;
        *bend += force * cubic_b;
    }

    /// Distributes the forces around the interval with the given left knot to the knots near it: the adjoint
    /// of [`LocalCubic`].
    #[inline]
    pub fn add_moments(&mut self, left: usize, moments: &ForceMoments<f64>) {
        let &[constant, first, second, third, behind, before] = moments;
        let knots = &mut self.knots[left..left + 4];
        knots[0][1] -= before;
        knots[1][0] += constant - first;
        knots[1][1] += 3.0 * second - 2.0 * first - third + behind + 2.0 * before;
        knots[2][0] += first;
        knots[2][1] += third - first - 2.0 * behind - before;
        knots[3][1] += behind;
    }

    /// Computes the generalised force on each curve: the sum, over all positions, of force times the curve's
    /// value.
    pub fn gather(&self, splines: &Splines, sums: &mut [f64]) {
        sums.fill(0.0);
        let curves = splines.knots.chunks_exact(splines.curves.max(1));
        for (&[force, moment], knots) in self.knots.iter().skip(1).zip(curves) {
            if force == 0.0 && moment == 0.0 {
                continue;
            }
            for (sum, [value, bend]) in sums.iter_mut().zip(knots) {
                *sum += force * value + moment * bend;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_is_the_sum_of_its_curves_there_and_back() {
        let curve = |k: i32| (0..9).map(|i| f64::from((i * k) % 5) - 1.7).collect();
        let splines = Splines::natural(1.0, 0.3, &[curve(2), curve(3)]);
        let (weights, rates) = ([0.7, -1.9], [2.3, 0.4]);
        let mut sum = WeightedSplines::default();
        sum.assemble(&splines, &weights, &rates);
        let mut spread = KnotForces::default();
        spread.clear(&splines);
        let mut direct = [0.0; 2];
        for (x, force) in [(1.5, 3.0), (1.7, -7.0), (2.05, 1.3), (9.0, 0.6)] {
            let place = splines.place(x);
            let (jet, rate) = sum.at(&splines, &place);
            let jets = [splines.jet(&place, 0), splines.jet(&place, 1)];
            let of = |by: [f64; 2], f: fn(&ValueAndDerivatives) -> f64| {
                by[0] * f(&jets[0]) + by[1] * f(&jets[1])
            };
            assert!((jet.value - of(weights, |j| j.value)).abs() < 1e-14);
            assert!((jet.first - of(weights, |j| j.first)).abs() < 1e-12);
            assert!((jet.second - of(weights, |j| j.second)).abs() < 1e-11);
            assert!((rate - of(rates, |j| j.value)).abs() < 1e-14);
            if place.clamped {
                spread.add(&place, force);
            } else {
                // the same from the interval itself and from both neighbours
                for left in [place.left.wrapping_sub(1), place.left, place.left + 1] {
                    if left >= 8 {
                        continue;
                    }
                    let t = place.t + place.left as f64 - left as f64;
                    let [value, slope, rising] = LocalCubic::new(sum.around(left)).at(t);
                    assert!((value - jet.value).abs() < 1e-13, "{x} from {left}");
                    assert!((slope / 0.3 - jet.first).abs() < 1e-12, "{x} from {left}");
                    assert!((rising - rate).abs() < 1e-13, "{x} from {left}");
                    spread.add_moments(left, &force_moments(t, force / 3.0));
                }
            }
            for (direct, jet) in direct.iter_mut().zip(jets) {
                *direct += force * jet.value;
            }
        }
        let mut gathered = [f64::NAN; 2];
        spread.gather(&splines, &mut gathered);
        for (gathered, direct) in gathered.iter().zip(direct) {
            assert!((gathered - direct).abs() < 1e-13, "{gathered} {direct}");
        }
    }
}
