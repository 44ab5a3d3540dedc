//! Backward differentiation formulas of variable step and order, the class of GSTIFF and DASSL.
//!
//! The corrector has a fixed leading coefficient: its polynomial passes through the new state and through the
//! predictor's values at equal distances `h` back, so that a step of order `k` is the stage `q = base_q + c
//! v` with `c = h / (1 + 1/2 + ... + 1/k)`. Brenan, Campbell and Petzold (1996), chapter 5. Work is
//! integrated by the same formula.
//!
//! Orders above 2 are not offered, because they are not A-stable: modes inside the instability wedge along the
//! imaginary axis grow until the error test cuts the step down to where they are resolved. The head's modes (0.5 %
//! damping) and the ropes' axial modes lie in it, so that higher orders cost more steps, not fewer: 434 with orders up
//! to 2, 77,911 up to 4 on the shipped unit (`docs/measurements.md`).
use super::newton::{ImplicitStage, Newton};
use super::step_control::StepControl;
use super::stepper::{StepResult, Stepper, TimeStep};
use crate::system::{Equations, Powers, State, System};

/// Highest order offered.
const HIGHEST: usize = 2;
/// Number of past states kept, which a predictor of the highest order interpolates.
const KEPT: usize = HIGHEST + 1;

/// Accepted state of the history, with the work done until then.
#[derive(Clone, Debug)]
struct Point {
    t: f64,
    q: Vec<f64>,
    v: Vec<f64>,
    /// Work done since the start of the run \[J\]: input, output, dissipated.
    work: [f64; 3],
}

/// Order considered for the next step, with the local error expected at it.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    order: usize,
    error: f64,
}

/// Variable-order BDF method with its history of accepted states.
#[derive(Clone, Debug)]
pub struct Bdf {
    highest: usize,
    order: usize,
    newton: Newton,
    /// Accepted states, the latest first; the first `points` of them are valid.
    past: Vec<Point>,
    points: usize,
    /// Number of steps made at the present order; the field `failures` counts rejected steps since the last
    /// accepted one.
    at_order: usize,
    failures: u32,
    /// Work since the start of the run at the end of the present step \[J\]: input, output, dissipated.
    work: [f64; 3],
    /// Next lower and next higher order, with the local errors that the last step would have had at them.
    neighbouring_orders: [Option<Candidate>; 2],
    base_q: Vec<f64>,
    base_v: Vec<f64>,
    /// Predicted coordinates during a step; afterwards its local error, the scaled difference between
    /// corrected and predicted coordinates.
    error: Vec<f64>,
}

const fn components(powers: &Powers) -> [f64; 3] {
    [powers.input, powers.output, powers.dissipated]
}

impl Bdf {
    /// Creates the method for a highest order (clamped to 1..=2), `n` coordinates and the local error allowed
    /// per step.
    pub fn new(highest: usize, n: usize, tolerance: f64) -> Self {
        let point = Point {
            t: 0.0,
            q: vec![0.0; n],
            v: vec![0.0; n],
            work: [0.0; 3],
        };
        Self {
            highest: highest.clamp(1, HIGHEST),
            order: 1,
            newton: Newton::new(n, tolerance),
            past: vec![point; KEPT],
            points: 0,
            at_order: 0,
            failures: 0,
            work: [0.0; 3],
            neighbouring_orders: [None; 2],
            base_q: vec![0.0; n],
            base_v: vec![0.0; n],
            error: vec![0.0; n],
        }
    }

    /// Creates the method with a given history `past` (latest state first, at least `order` + 1 states); its
    /// steps have the fixed order `order` (clamped to 1..=2).
    pub fn continuing(order: usize, past: &[State], tolerance: f64) -> Self {
        let n = past.first().map_or(0, |state| state.q.len());
        let mut method = Self::new(order, n, tolerance);
        for (point, state) in method.past.iter_mut().zip(past) {
            point.t = state.t;
            point.q.copy_from_slice(&state.q);
            point.v.copy_from_slice(&state.v);
            method.points += 1;
        }
        method.order = method.highest.min(method.points.max(2) - 1);
        method
    }

    /// Returns the order of the formula for the next step.
    pub const fn order(&self) -> usize {
        self.order
    }

    /// Initialises the history for the first step: the start and a fictitious state `h` earlier, extrapolated
    /// along the tangent.
    fn begin(&mut self, from: &State, h: f64) {
        let [now, before, ..] = self.past.as_mut_slice() else {
            return;
        };
        now.t = from.t;
        now.q.copy_from_slice(&from.q);
        now.v.copy_from_slice(&from.v);
        before.t = from.t - h;
        for k in 0..from.q.len() {
            before.q[k] = from.q[k] - h * from.v[k];
            before.v[k] = from.v[k] - h * from.a[k];
        }
    }

    /// Returns the weights of the past states in the predicted value and in its rate, both at time `t`.
    fn predictor(&self, t: f64) -> [[f64; KEPT]; 2] {
        let mut weights = [[0.0; KEPT]; 2];
        let points = &self.past[..=self.order];
        for (i, own) in points.iter().enumerate() {
            let (mut value, mut rate) = (1.0, 0.0);
            for (j, other) in points.iter().enumerate() {
                if i != j {
                    value *= (t - other.t) / (own.t - other.t);
                    rate += 1.0 / (t - other.t);
                }
            }
            weights[0][i] = value;
            weights[1][i] = value * rate;
        }
        weights
    }

    /// Computes the predicted coordinates (into `error`) and rates (into `v`) at time `t`, and the bases
    /// (known parts) of the implicit stage; returns the corresponding bases of the work.
    fn predict(&mut self, t: f64, c: f64, v: &mut [f64]) -> [f64; 3] {
        let [value, rate] = self.predictor(t);
        let used = self.order + 1;
        let (value, rate) = (&value[..used], &rate[..used]);
        let past = &self.past;
        for k in 0..self.error.len() {
            let [mut q, mut dq, mut u, mut du] = [0.0; 4];
            for (point, (&value, &rate)) in past.iter().zip(value.iter().zip(rate)) {
                q += value * point.q[k];
                dq += rate * point.q[k];
                u += value * point.v[k];
                du += rate * point.v[k];
            }
            self.error[k] = q;
            self.base_q[k] = q - c * dq;
            self.base_v[k] = u - c * du;
            v[k] = dq;
        }
        std::array::from_fn(|k| {
            let weighted = past.iter().zip(value.iter().zip(rate));
            weighted
                .map(|(point, (value, rate))| (value - c * rate) * point.work[k])
                .sum()
        })
    }

    /// Returns the error constant of a step to time `t`: ratio of the local error to the difference between
    /// corrected and predicted coordinates.
    fn constant(&self, t: f64, h: f64) -> f64 {
        let last = h / (t - self.past[self.order].t);
        let mut own = 0.0;
        let mut fixed = 0.0;
        for (i, point) in self.past[..self.order].iter().enumerate() {
            own += h / (t - point.t);
            fixed += 1.0 / (i + 1) as f64;
        }
        last.max((last + own - fixed).abs())
    }

    /// Estimates the local error that the formula of order `order` would have had in this step, from divided
    /// differences of the states.
    fn error_at<E: Equations>(&mut self, order: usize, equations: &E, to: &State) -> Candidate {
        let h = to.t - self.past[0].t;
        let earlier = &self.past[..=order];
        let mut scale = 1.0;
        for i in 1..=order {
            scale *= i as f64;
        }
        for _ in 0..=order {
            scale *= h;
        }
        // order! h^(order + 1) times the divided difference: h^(order + 1) q^(order + 1) / (order + 1)
        let first: f64 = earlier.iter().map(|other| to.t - other.t).product();
        for (difference, q) in self.error.iter_mut().zip(&to.q) {
            *difference = scale / first * q;
        }
        for (i, own) in earlier.iter().enumerate() {
            let mut product = own.t - to.t;
            for (j, other) in earlier.iter().enumerate() {
                if i != j {
                    product *= own.t - other.t;
                }
            }
            let weight = scale / product;
            for (difference, q) in self.error.iter_mut().zip(&own.q) {
                *difference += weight * q;
            }
        }
        Candidate {
            order,
            error: equations.error_norm(&self.error),
        }
    }
}

impl<E: Equations> Stepper<E> for Bdf {
    fn step(&mut self, system: &mut System<E>, from: &State, h: f64, to: &mut State) -> StepResult {
        if self.points == 0 {
            self.begin(from, h);
        }
        let t = from.t + h;
        let sum: f64 = (1..=self.order).map(|i| 1.0 / i as f64).sum();
        let c = h / sum;
        let base_work = self.predict(t, c, &mut to.v);
        let stage = ImplicitStage {
            t,
            c,
            d: c,
            base_q: &self.base_q,
            base_v: &self.base_v,
        };
        let own = (&mut to.q[..], &mut to.v[..], &mut to.a[..]);
        let powers = components(&self.newton.solve(system, &stage, own)?);
        to.t = t;
        let constant = self.constant(t, h);
        for (error, q) in self.error.iter_mut().zip(&to.q) {
            *error = constant * (q - *error);
        }
        let [input, output, dissipated] = std::array::from_fn(|k| {
            self.work[k] = base_work[k] + c * powers[k];
            self.work[k] - self.past[0].work[k]
        });
        Ok(TimeStep {
            error: system.equations.error_norm(&self.error),
            work: Powers {
                input,
                output,
                dissipated,
            },
        })
    }

    fn accept(&mut self, equations: &E, to: &State) {
        self.failures = 0;
        self.at_order += 1;
        // the fictitious point of the first step is worth no more than its tangent
        let known = self.points.max(1);
        let order = self.order;
        let ripe = self.at_order > order;
        self.neighbouring_orders = [
            (ripe && order > 1).then(|| self.error_at(order - 1, equations, to)),
            (ripe && order < self.highest && known > order + 1)
                .then(|| self.error_at(order + 1, equations, to)),
        ];
        self.past.rotate_right(1);
        let newest = &mut self.past[0];
        newest.t = to.t;
        newest.q.copy_from_slice(&to.q);
        newest.v.copy_from_slice(&to.v);
        newest.work = self.work;
        self.points = (known + 1).min(KEPT);
    }

    fn reject(&mut self) {
        self.failures += 1;
        self.at_order = 0;
        if self.failures > 1 {
            self.order = if self.failures > 2 {
                1
            } else {
                self.order.max(2) - 1
            };
        }
    }

    fn error_order(&self) -> f64 {
        self.order as f64 + 1.0
    }

    fn next(&mut self, control: &StepControl, step: f64, error: f64) -> f64 {
        let factor = |order: usize, error: f64| {
            let control = StepControl {
                order: order as f64 + 1.0,
                ..*control
            };
            control.factor(error)
        };
        let mut best = (self.order, error, factor(self.order, error));
        for other in self.neighbouring_orders.into_iter().flatten() {
            // another order must be worth the change
            let gain = factor(other.order, other.error);
            if gain > 1.15 * best.2 || (other.order < best.0 && gain > 1.02 * best.2) {
                best = (other.order, other.error, gain);
            }
        }
        if best.0 == self.order {
            return control.next(step, error);
        }
        self.order = best.0;
        self.at_order = 0;
        let control = StepControl {
            order: best.0 as f64 + 1.0,
            ..*control
        };
        control.next(step, best.1)
    }
}
