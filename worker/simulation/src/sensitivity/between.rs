//! Interpolation of derivative columns within a step: derivatives of the state, of suspension height and
//! crank torque, and of gauge stress.
use super::block::Motion;
use crate::integrator::dense::Weights;
use crate::linear::Lanes;
use crate::observe::{Gradient, TorqueBy};
use crate::system::State;

/// Adds `step` times a column, interpolated within a step, to a state.
pub(super) fn add_column(
    [from, to]: [&Motion; 2],
    lane: usize,
    weights: &Weights,
    step: f64,
    out: &mut State,
) {
    let [f0, f1] = weights.value.map(|weight| step * weight);
    let [g0, g1] = weights.slope.map(|weight| step * weight);
    let [r, s] = weights.linear.map(|weight| step * weight);
    for i in 0..out.q.len() {
        let of = |x: &[Lanes]| x[i].0[lane];
        let [a0, a1] = [of(&from.a), of(&to.a)];
        let [v0, v1] = [of(&from.v), of(&to.v)];
        out.q[i] += f0 * of(&from.q) + f1 * of(&to.q) + g0 * v0 + g1 * v1;
        out.v[i] += f0 * v0 + f1 * v1 + g0 * a0 + g1 * a1;
        out.a[i] += r * a0 + s * a1;
    }
}

/// Returns the interpolated derivatives of coordinate `i` and of its rate, one lane per derivative column.
fn at([from, to]: [&Motion; 2], weights: &Weights, i: usize) -> [Lanes; 2] {
    let [f0, f1] = weights.value;
    let [g0, g1] = weights.slope;
    [
        from.q[i] * f0 + to.q[i] * f1 + from.v[i] * g0 + to.v[i] * g1,
        from.v[i] * f0 + to.v[i] * f1 + from.a[i] * g0 + to.a[i] * g1,
    ]
}

/// Returns the interpolated derivatives of the acceleration of coordinate `i`, one lane per derivative
/// column.
fn acceleration([from, to]: [&Motion; 2], weights: &Weights, i: usize) -> Lanes {
    let [r, s] = weights.linear;
    from.a[i] * r + to.a[i] * s
}

/// Returns the interpolated derivatives of the suspension height (coordinate index `height`) and of the crank
/// torque, one lane per derivative column.
pub(super) fn shaft(
    ends: [&Motion; 2],
    weights: &Weights,
    height: usize,
    torque: &TorqueBy,
) -> [Lanes; 2] {
    let mut sum = Lanes::default();
    for (i, [by_place, by_rate, by_acceleration]) in &torque.0 {
        let [q, v] = at(ends, weights, *i);
        let a = acceleration(ends, weights, *i);
        sum += q * *by_place + v * *by_rate + a * *by_acceleration;
    }
    let [height, _] = at(ends, weights, height);
    [height, sum]
}

/// Returns the interpolated derivatives of the stress at the four gauges, one lane per derivative column.
pub(super) fn stress(
    ends: [&Motion; 2],
    weights: &Weights,
    gradient: &Gradient,
    beam: usize,
) -> [Lanes; 4] {
    let mut sum = [Lanes::default(); 4];
    for (i, [by_place, by_rate]) in &gradient.entries {
        let [q, v] = at(ends, weights, *i);
        for (gauge, sum) in sum.iter_mut().enumerate() {
            *sum += q * by_place[gauge] + v * by_rate[gauge];
        }
    }
    let a = acceleration(ends, weights, beam);
    for (sum, by) in sum.iter_mut().zip(gradient.by_acceleration) {
        *sum += a * by;
    }
    sum
}
