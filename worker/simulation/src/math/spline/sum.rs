//! Weighted sum of splines on one grid, evaluated as a single spline.
//!
//! If the same weights apply at many positions, the curves are summed once at each grid point (knot), and
//! each position costs the evaluation of one curve. The adjoint works likewise: forces at positions are
//! distributed to the knots, and the generalised force on each curve is gathered from the knots at the end.
use super::{SplinePosition, Splines, ValueAndDerivatives};

/// Two sums of the curves of [`Splines`], evaluated like single splines: weighted with the weights, and with
/// the weights' time derivatives.
#[derive(Clone, Debug, Default)]
pub struct WeightedSplines {
    /// Values at each knot: value and scaled second derivative of the sum with the weights, then of the sum
    /// with the weights' time derivatives.
    knots: Vec<[f64; 4]>,
}

/// Forces at positions on a spline grid, distributed to its knots: sums weighted for the value and for the
/// scaled second derivative at each knot.
#[derive(Clone, Debug, Default)]
pub struct KnotForces {
    knots: Vec<[f64; 2]>,
}

impl WeightedSplines {
    /// Computes the two sums of the curves, with `weights` and with their time derivatives `rates`; both hold
    /// one number per curve.
    pub fn assemble(&mut self, splines: &Splines, weights: &[f64], rates: &[f64]) {
        let points = splines.points();
        self.knots.resize(points, [0.0; 4]);
        let curves = splines.knots.chunks_exact(splines.curves.max(1));
        for (sum, knots) in self.knots.iter_mut().zip(curves) {
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
        let [y0, m0, dy0, dm0] = self.knots[place.left];
        let [y1, m1, dy1, dm1] = self.knots[place.right];
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

    /// Computes, at several grid positions, values and slopes of the sum with the weights and values of the
    /// sum with the weights' time derivatives.
    pub fn evaluate_all(
        &self,
        splines: &Splines,
        places: &[SplinePosition],
        sums: [&mut [f64]; 3],
    ) {
        let [values, slopes, rates] = sums;
        let sums = values.iter_mut().zip(slopes).zip(rates);
        for (place, ((value, slope), rate)) in places.iter().zip(sums) {
            let (jet, rising) = self.at(splines, place);
            *value = jet.value;
            *slope = jet.first;
            *rate = rising;
        }
    }
}

impl KnotForces {
    /// Sets all forces to zero and resizes to the grid of `splines`.
    pub fn clear(&mut self, splines: &Splines) {
        self.knots.clear();
        self.knots.resize(splines.points(), [0.0; 2]);
    }

    /// Distributes `force` at a grid position to the neighbouring knots.
    #[inline]
    pub fn add(&mut self, place: &SplinePosition, force: f64) {
        let [a, b, cubic_a, cubic_b] = place.weights();
        let [value, bend] = &mut self.knots[place.left];
        *value += force * a;
        *bend += force * cubic_a;
        let [value, bend] = &mut self.knots[place.right];
        *value += force * b;
        *bend += force * cubic_b;
    }

    /// Computes the generalised force on each curve: the sum, over all positions, of force times the curve's
    /// value.
    pub fn gather(&self, splines: &Splines, sums: &mut [f64]) {
        sums.fill(0.0);
        let curves = splines.knots.chunks_exact(splines.curves.max(1));
        for (&[force, moment], knots) in self.knots.iter().zip(curves) {
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
        for (x, force) in [(0.2, 3.0), (1.4, -7.0), (2.05, 1.3), (9.0, 0.6)] {
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
            spread.add(&place, force);
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
