//! Cubic splines on equal spacing, several curves on one grid.
//!
//! Twice continuously differentiable, so that an adaptive integrator need not reduce its steps at the grid
//! points of a tabulated force.

pub mod sum;

/// Several cubic splines over the same equally spaced abscissae.
#[derive(Clone, Debug)]
pub struct Splines {
    start: f64,
    step: f64,
    per_step: f64,
    periodic: bool,
    curves: usize,
    /// Value and second derivative times step^2 / 6 of each curve at each grid point, ordered point by point.
    knots: Vec<[f64; 2]>,
}

/// Value and first two derivatives of a spline at one position.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ValueAndDerivatives {
    /// Value of the spline.
    pub value: f64,
    /// First derivative of the spline.
    pub first: f64,
    /// Second derivative of the spline.
    pub second: f64,
}

/// Position on the common grid of several splines: enclosing grid points and local coordinate, computed once
/// for all curves.
#[derive(Clone, Copy, Debug, Default)]
pub struct SplinePosition {
    left: usize,
    right: usize,
    t: f64,
    clamped: bool,
}

impl SplinePosition {
    /// Returns the interpolation weights for values, then for scaled second derivatives, each at the left and
    /// the right grid point.
    #[inline]
    const fn weights(&self) -> [f64; 4] {
        let b = self.t;
        let a = 1.0 - b;
        [a, b, a * a * a - a, b * b * b - b]
    }
}

impl Splines {
    /// Creates natural splines through the values `curves[c][i]` at abscissae `start + i * step`, constant
    /// beyond the ends. Fewer than two points give a constant.
    pub fn natural(start: f64, step: f64, curves: &[Vec<f64>]) -> Self {
        Self::new(start, step, curves, false)
    }

    /// Creates periodic splines through equally spaced values; after the last value the first one follows.
    pub fn periodic(start: f64, step: f64, curves: &[Vec<f64>]) -> Self {
        Self::new(start, step, curves, true)
    }

    fn new(start: f64, step: f64, curves: &[Vec<f64>], periodic: bool) -> Self {
        let points = curves.iter().map(Vec::len).min().unwrap_or(0);
        let mut knots = vec![[0.0; 2]; points * curves.len()];
        for (c, curve) in curves.iter().enumerate() {
            let bends = if periodic {
                periodic_second_derivatives(&curve[..points])
            } else {
                natural_second_derivatives(&curve[..points])
            };
            for i in 0..points {
                knots[i * curves.len() + c] = [curve[i], bends[i] / 6.0];
            }
        }
        Self {
            start,
            step,
            per_step: 1.0 / step,
            periodic,
            curves: curves.len(),
            knots,
        }
    }

    /// Returns the number of splines on the grid.
    pub const fn curves(&self) -> usize {
        self.curves
    }

    /// Returns the number of points on the grid.
    fn points(&self) -> usize {
        self.knots.len() / self.curves.max(1)
    }

    /// Returns the grid position of the abscissa `x`, with which all curves can be evaluated.
    #[inline]
    pub fn place(&self, x: f64) -> SplinePosition {
        let points = self.points();
        let u = (x - self.start) * self.per_step;
        if self.periodic {
            let n = points as f64;
            let u = u - (u / n).floor() * n;
            let left = (index(u)).min(points.saturating_sub(1));
            return SplinePosition {
                left,
                right: if left + 1 == points { 0 } else { left + 1 },
                t: u - left as f64,
                clamped: false,
            };
        }
        let last = points.saturating_sub(1);
        let clamped = !(u >= 0.0 && u <= last as f64);
        let u = u.clamp(0.0, last as f64);
        let left = index(u).min(last.saturating_sub(1));
        SplinePosition {
            left,
            right: (left + 1).min(last),
            t: u - left as f64,
            clamped,
        }
    }

    /// Returns the abscissa `x` in grid intervals from the first point, without regard to the grid's ends.
    #[inline]
    pub(crate) fn in_steps(&self, x: f64) -> f64 {
        (x - self.start) * self.per_step
    }

    /// Returns the number of grid intervals per unit of the abscissa.
    pub(crate) const fn per_step(&self) -> f64 {
        self.per_step
    }

    /// Returns the index of the last point of the grid.
    pub(crate) fn last(&self) -> usize {
        self.points().saturating_sub(1)
    }

    /// Returns value and first two derivatives of the spline with index `curve` at a grid position.
    #[inline]
    pub fn jet(&self, place: &SplinePosition, curve: usize) -> ValueAndDerivatives {
        let [y0, m0] = self.knots[place.left * self.curves + curve];
        let [y1, m1] = self.knots[place.right * self.curves + curve];
        let b = place.t;
        let a = 1.0 - b;
        let value = a * y0 + b * y1 + (a * a * a - a) * m0 + (b * b * b - b) * m1;
        if place.clamped {
            return ValueAndDerivatives {
                value,
                first: 0.0,
                second: 0.0,
            };
        }
        let first = (y1 - y0 + (1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1) / self.step;
        let second = 6.0 * (a * m0 + b * m1) / (self.step * self.step);
        ValueAndDerivatives {
            value,
            first,
            second,
        }
    }

    /// Computes the values of the first `values.len()` splines at a grid position.
    pub fn values(&self, place: &SplinePosition, values: &mut [f64]) {
        let left = &self.knots[place.left * self.curves..];
        let right = &self.knots[place.right * self.curves..];
        let [a, b, cubic_a, cubic_b] = place.weights();
        for (value, (&[y0, m0], &[y1, m1])) in values.iter_mut().zip(left.iter().zip(right)) {
            *value = a * y0 + b * y1 + cubic_a * m0 + cubic_b * m1;
        }
    }

    /// Computes the values and first derivatives of the first `values.len()` splines at a grid position.
    pub fn slopes(&self, place: &SplinePosition, values: &mut [f64], slopes: &mut [f64]) {
        let left = &self.knots[place.left * self.curves..];
        let right = &self.knots[place.right * self.curves..];
        let [a, b, cubic_a, cubic_b] = place.weights();
        let inside = if place.clamped { 0.0 } else { self.per_step };
        let (bend_a, bend_b) = (1.0 - 3.0 * a * a, 3.0 * b * b - 1.0);
        let curves = left.iter().zip(right);
        for ((value, slope), (&[y0, m0], &[y1, m1])) in values.iter_mut().zip(slopes).zip(curves) {
            *value = a * y0 + b * y1 + cubic_a * m0 + cubic_b * m1;
            *slope = (y1 - y0 + bend_a * m0 + bend_b * m1) * inside;
        }
    }

    /// Returns the value of the spline with index `curve` at the abscissa `x`.
    pub fn value(&self, x: f64, curve: usize) -> f64 {
        self.jet(&self.place(x), curve).value
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the argument was reduced to the grid, so it is small and not negative"
)]
fn index(u: f64) -> usize {
    u as usize
}

/// Returns the second derivatives times step^2, at the grid points, of the natural spline through the values
/// `y` (Thomas algorithm).
fn natural_second_derivatives(y: &[f64]) -> Vec<f64> {
    let n = y.len();
    let mut bends = vec![0.0; n];
    if n < 3 {
        return bends;
    }
    let mut ratio = vec![0.0; n];
    for i in 1..n - 1 {
        let right = 6.0 * (y[i + 1] - 2.0 * y[i] + y[i - 1]);
        let pivot = 4.0 - ratio[i - 1];
        ratio[i] = 1.0 / pivot;
        bends[i] = (right - bends[i - 1]) / pivot;
    }
    for i in (1..n - 1).rev() {
        bends[i] -= ratio[i] * bends[i + 1];
    }
    bends
}

/// Returns the second derivatives times step^2, at the grid points, of the periodic spline through the values
/// `y`.
///
/// The circulant system (1, 4, 1) is solved with its decaying Green's function, which is exact to rounding
/// after 30 neighbours.
fn periodic_second_derivatives(y: &[f64]) -> Vec<f64> {
    let n = y.len();
    if n < 3 {
        return vec![0.0; n];
    }
    let at = |i: usize| y[i % n];
    let right: Vec<f64> = (0..n)
        .map(|i| 6.0 * (at(i + 1) - 2.0 * y[i] + at(i + n - 1)))
        .collect();
    let z = 3.0_f64.sqrt() - 2.0;
    let scale = 1.0 / (2.0 * 3.0_f64.sqrt());
    let reach = 32;
    (0..n)
        .map(|i| {
            let mut sum = right[i];
            let mut weight = 1.0;
            for k in 1..=reach {
                weight *= z;
                sum += weight * (right[(i + k) % n] + right[(i + n * reach - k) % n]);
            }
            sum * scale
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::elementary::sin_cos;

    #[test]
    fn periodic_spline_follows_a_sine_to_fourth_order() {
        let mut errors = Vec::new();
        for n in [24_usize, 48] {
            let step = std::f64::consts::TAU / n as f64;
            let y: Vec<f64> = (0..n).map(|i| sin_cos(i as f64 * step).0).collect();
            let spline = Splines::periodic(0.0, step, &[y]);
            let mut worst: f64 = 0.0;
            for k in 0..997 {
                let x = -7.0 + 0.0173 * f64::from(k);
                let jet = spline.jet(&spline.place(x), 0);
                let (s, c) = sin_cos(x);
                worst = worst.max((jet.value - s).abs());
                assert!((jet.first - c).abs() < 2e-3 && (jet.second + s).abs() < 2e-2);
            }
            errors.push(worst);
        }
        let order = (errors[0] / errors[1]).log2();
        assert!((3.7..4.3).contains(&order), "{order}");
    }

    #[test]
    fn natural_spline_is_exact_on_lines_and_constant_beyond() {
        let y: Vec<f64> = (0..9).map(|i| 3.0 - 0.25 * f64::from(i)).collect();
        let spline = Splines::natural(10.0, 0.5, &[y.clone(), y]);
        let jet = spline.jet(&spline.place(11.3), 1);
        assert!((jet.value - (3.0 - 0.5 * 1.3)).abs() < 1e-14);
        assert!((jet.first + 0.5).abs() < 1e-13 && jet.second.abs() < 1e-12);
        let beyond = spline.jet(&spline.place(99.0), 0);
        assert!((beyond.value - 1.0).abs() < 1e-14 && beyond.first == 0.0);
    }
}
