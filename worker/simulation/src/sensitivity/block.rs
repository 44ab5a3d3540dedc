//! Columns of the state, several side by side, through the stages of a step.
use super::tangents::Tangents;
use crate::integrator::dense::Weights;
use crate::integrator::tableau::Tableau;
use crate::linear::Lanes;
use crate::observe::{Gradient, TorqueBy};
use crate::system::{Equations, State};

/// Derivatives of coordinates, rates and accelerations; n each.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) q: Vec<Lanes>,
    pub(super) v: Vec<Lanes>,
    pub(super) a: Vec<Lanes>,
}

/// Columns of a state and of the stages of the step that begins there.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// Where the step began, and where it ended.
    pub(super) ends: [Motion; 2],
    /// Rates and accelerations of the stages between.
    stages: Vec<[Vec<Lanes>; 2]>,
}

/// Room for what a stage is without its own acceleration, and for a product.
#[derive(Clone, Debug)]
pub(super) struct Bases {
    q: Vec<Lanes>,
    v: Vec<Lanes>,
    scaled: Vec<Lanes>,
}

impl Motion {
    fn new(n: usize) -> Self {
        let zeros = || vec![Lanes::default(); n];
        Self {
            q: zeros(),
            v: zeros(),
            a: zeros(),
        }
    }

    /// Largest derivative of a coordinate in a column.
    pub(super) fn size(&self, lane: usize) -> f64 {
        self.q.iter().fold(0.0, |size, q| q.0[lane].abs().max(size))
    }
}

impl Bases {
    /// For `n` coordinates.
    pub(super) fn new(n: usize) -> Self {
        let Motion { q, v, a } = Motion::new(n);
        Self { q, v, scaled: a }
    }
}

impl Block {
    /// Zeros for `n` coordinates and a method of so many stages.
    pub(super) fn new(n: usize, stages: usize) -> Self {
        let zeros = || vec![Lanes::default(); n];
        Self {
            ends: [Motion::new(n), Motion::new(n)],
            stages: (0..stages).map(|_| [zeros(), zeros()]).collect(),
        }
    }

    /// Columns of an equilibrium, whose `dR/dp` is in `right`.
    pub(super) fn rest(&mut self, tangents: &Tangents, right: &mut [Lanes]) {
        tangents.factor.solve_lanes(right);
        self.ends[0].q.copy_from_slice(right);
    }

    /// Columns of stage `i` of a step of size `h`, whose `dR/dp` is in `right`.
    pub(super) fn stage<E: Equations>(
        &mut self,
        equations: &E,
        tangents: &Tangents,
        (tableau, i, h): (&Tableau, usize, f64),
        right: &mut [Lanes],
        bases: &mut Bases,
    ) {
        let Self {
            ends: [from, to],
            stages,
        } = self;
        let row = tableau.rows[i];
        let first = h * row[0];
        for (k, (q, v)) in bases.q.iter_mut().zip(&mut bases.v).enumerate() {
            *q = from.q[k] + from.v[k] * first;
            *v = from.v[k] + from.a[k] * first;
        }
        for (weight, [v, a]) in row[1..]
            .iter()
            .zip(&*stages)
            .filter(|(weight, _)| **weight != 0.0)
        {
            let weight = h * weight;
            let each = bases.q.iter_mut().zip(&mut bases.v).zip(v.iter().zip(a));
            for ((base_q, base_v), (v, a)) in each {
                *base_q += *v * weight;
                *base_v += *a * weight;
            }
        }
        let shift = 1.0 / (tableau.diagonal * h);
        tangents.stiffness.subtract_product_lanes(&bases.q, right);
        for (scaled, v) in bases.scaled.iter_mut().zip(&bases.v) {
            *scaled = *v * -shift;
        }
        equations.subtract_inertia(&tangents.state.q, &bases.scaled, right);
        tangents.factor.solve_lanes(right);
        let last = i + 1 == tableau.stages();
        let (v, a) = if last {
            for (k, q) in to.q.iter_mut().enumerate() {
                *q = bases.q[k] + right[k];
            }
            (&mut to.v, &mut to.a)
        } else {
            let [v, a] = &mut stages[i - 1];
            (v, a)
        };
        let each = v.iter_mut().zip(a).zip(right.iter().zip(&bases.v));
        for ((v, a), (w, base)) in each {
            *v = *w * shift;
            *a = (*v - *base) * shift;
        }
    }

    /// The step is over: it ended where the next one begins.
    pub(super) const fn accept(&mut self) {
        let [from, to] = &mut self.ends;
        std::mem::swap(from, to);
    }
}

/// Adds `step` times a column to a state: at a place between two ends.
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

/// Derivatives of the suspension's coordinate `height` and of the torque along the columns between two
/// ends.
pub(super) fn shaft(
    [from, to]: [&Motion; 2],
    weights: &Weights,
    height: usize,
    torque: &TorqueBy,
) -> [Lanes; 2] {
    let [f0, f1] = weights.value;
    let [g0, g1] = weights.slope;
    let [r, s] = weights.linear;
    let place = |i: usize| from.q[i] * f0 + to.q[i] * f1 + from.v[i] * g0 + to.v[i] * g1;
    let mut sum = Lanes::default();
    for (i, [by_place, by_rate, by_acceleration]) in &torque.0 {
        let i = *i;
        let v = from.v[i] * f0 + to.v[i] * f1 + from.a[i] * g0 + to.a[i] * g1;
        let a = from.a[i] * r + to.a[i] * s;
        sum += place(i) * *by_place + v * *by_rate + a * *by_acceleration;
    }
    [place(height), sum]
}

/// Derivatives of the gauges' stress along the columns between two ends.
pub(super) fn stress(
    [from, to]: [&Motion; 2],
    weights: &Weights,
    gradient: &Gradient,
    beam: usize,
) -> [Lanes; 4] {
    let [f0, f1] = weights.value;
    let [g0, g1] = weights.slope;
    let [r, s] = weights.linear;
    let mut sum = [Lanes::default(); 4];
    for (i, [by_place, by_rate]) in &gradient.entries {
        let i = *i;
        let q = from.q[i] * f0 + to.q[i] * f1 + from.v[i] * g0 + to.v[i] * g1;
        let v = from.v[i] * f0 + to.v[i] * f1 + from.a[i] * g0 + to.a[i] * g1;
        for (gauge, sum) in sum.iter_mut().enumerate() {
            *sum += q * by_place[gauge] + v * by_rate[gauge];
        }
    }
    let a = from.a[beam] * r + to.a[beam] * s;
    for (sum, by) in sum.iter_mut().zip(gradient.by_acceleration) {
        *sum += a * by;
    }
    sum
}
