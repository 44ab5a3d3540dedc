//! Dense output: cubic Hermite interpolation between two accepted states.
use crate::system::State;

/// Weights with which the states at the two ends of a step enter the interpolated state between them.
#[derive(Clone, Copy, Debug)]
pub struct Weights {
    /// Weights of the quantity's values at the two ends in cubic interpolation.
    pub value: [f64; 2],
    /// Weights of the quantity's time derivatives at the two ends in cubic interpolation \[s\].
    pub slope: [f64; 2],
    /// Weights of the values at the two ends in linear interpolation.
    pub linear: [f64; 2],
}

impl Weights {
    /// Returns the weights at time `t` of a step between the times `from` and `to`.
    pub fn at([from, to]: [f64; 2], t: f64) -> Self {
        let h = to - from;
        let s = (t - from) / h;
        let r = 1.0 - s;
        Self {
            value: [r * r * (1.0 + 2.0 * s), s * s * (1.0 + 2.0 * r)],
            slope: [s * r * r * h, -s * s * r * h],
            linear: [r, s],
        }
    }
}

/// Interpolates the state at time `t` between the states `from` and `to` into `out`.
///
/// Coordinates are interpolated cubically from coordinates and rates at both ends, rates cubically from rates
/// and accelerations; accelerations are interpolated linearly.
pub fn interpolate(from: &State, to: &State, t: f64, out: &mut State) {
    let Weights {
        value: [f0, f1],
        slope: [g0, g1],
        linear: [r, s],
    } = Weights::at([from.t, to.t], t);
    out.t = t;
    for i in 0..out.q.len() {
        out.q[i] = f0 * from.q[i] + f1 * to.q[i] + g0 * from.v[i] + g1 * to.v[i];
        out.v[i] = f0 * from.v[i] + f1 * to.v[i] + g0 * from.a[i] + g1 * to.a[i];
        out.a[i] = r * from.a[i] + s * to.a[i];
    }
}
