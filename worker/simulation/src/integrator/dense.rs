//! Dense output: cubic Hermite interpolation between two accepted states.
use crate::system::State;

/// Weights of the two ends of a step in the interpolated state between them.
#[derive(Clone, Copy, Debug)]
pub struct Weights {
    /// Weights of the interpolated quantity at both ends.
    pub value: [f64; 2],
    /// Weights of the quantity's time derivative at both ends \[s\].
    pub slope: [f64; 2],
    /// Weights of linearly interpolated quantities at both ends.
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

/// Interpolates the state at time `t` between `from` and `to` into `out`.
///
/// Coordinates are interpolated from coordinates and rates of both ends, rates from rates and accelerations;
/// accelerations are linear.
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
