//! Dense output: cubic Hermite interpolation between two accepted states.
use crate::system::State;

/// Interpolates at time `t` between `from` and `to` into `out`.
///
/// Coordinates use coordinates and rates of both ends, rates use rates and accelerations,
/// accelerations are linear.
pub fn interpolate(from: &State, to: &State, t: f64, out: &mut State) {
    let h = to.t - from.t;
    let s = (t - from.t) / h;
    let r = 1.0 - s;
    let (f0, f1) = (r * r * (1.0 + 2.0 * s), s * s * (1.0 + 2.0 * r));
    let (g0, g1) = (s * r * r * h, -s * s * r * h);
    out.t = t;
    for i in 0..out.q.len() {
        out.q[i] = f0 * from.q[i] + f1 * to.q[i] + g0 * from.v[i] + g1 * to.v[i];
        out.v[i] = f0 * from.v[i] + f1 * to.v[i] + g0 * from.a[i] + g1 * to.a[i];
        out.a[i] = r * from.a[i] + s * to.a[i];
    }
}
