//! Singly diagonally implicit Runge-Kutta methods with an explicit first stage, for second-order
//! systems.
//!
//! Every implicit stage is `q = base_q + c v`, `v = base_v + c a`, `M a = Q(q, v, t)` with the same
//! `c`, so one factorisation of `M / c^2 - D / c - K` serves all of them.
use super::newton::{ImplicitStage, Newton};
use super::stepper::{Stages, StepResult, Stepper, TimeStep};
use super::tableau::Tableau;
use crate::math::vector::{add_scaled, set_sum};
use crate::system::{Equations, Powers, State, System};

/// ESDIRK method with its buffers.
#[derive(Clone, Debug)]
pub struct Esdirk {
    tableau: &'static Tableau,
    newton: Newton,
    /// Rates and accelerations at all stages of the present step except the last.
    stages: Vec<(Vec<f64>, Vec<f64>)>,
    powers: Vec<Powers>,
    base_q: Vec<f64>,
    base_v: Vec<f64>,
    error: Vec<f64>,
}

impl Esdirk {
    /// Creates the method from its tableau (coefficients), the number `n` of coordinates and the local error
    /// allowed per step.
    pub fn new(tableau: &'static Tableau, n: usize, tolerance: f64) -> Self {
        Self {
            tableau,
            newton: Newton::new(n, tolerance),
            stages: vec![(vec![0.0; n], vec![0.0; n]); tableau.stages() - 1],
            powers: vec![Powers::default(); tableau.stages()],
            base_q: vec![0.0; n],
            base_v: vec![0.0; n],
            error: vec![0.0; n],
        }
    }

    /// Computes the bases of stage `i`: the parts of its coordinates and rates known before the stage's own
    /// rate and acceleration are solved for.
    fn bases(&mut self, i: usize, h: f64, from: &State) {
        self.base_q.copy_from_slice(&from.q);
        self.base_v.copy_from_slice(&from.v);
        for (weight, (v, a)) in self.tableau.rows[i].iter().zip(&self.stages) {
            let weight = h * weight;
            add_scaled(&mut self.base_q, weight, v);
            add_scaled(&mut self.base_v, weight, a);
        }
    }

    /// Predicts the rates of stage `i` by extrapolating the accelerations of earlier stages.
    fn predict(&self, i: usize, c: f64, to: &mut State) {
        let node = self.tableau.nodes[i];
        let (_, first) = &self.stages[0];
        if i == 1 {
            set_sum(&mut to.v, &self.base_v, c, first);
            return;
        }
        // linear through the first stage and the latest one
        let (_, latest) = &self.stages[i - 1];
        let ratio = node / self.tableau.nodes[i - 1];
        set_sum(&mut to.v, &self.base_v, c * (1.0 - ratio), first);
        add_scaled(&mut to.v, c * ratio, latest);
    }

    fn estimate(&mut self, h: f64, to: &State) {
        let tableau = self.tableau;
        let last = tableau.stages() - 1;
        let weight = |i: usize| h * (tableau.weight(i) - tableau.embedded[i]);
        for (k, error) in self.error.iter_mut().enumerate() {
            *error = weight(last) * to.v[k];
        }
        for (i, (v, _)) in self.stages.iter().enumerate() {
            add_scaled(&mut self.error, weight(i), v);
        }
    }

    fn work(&self, h: f64) -> Powers {
        let mut work = Powers::default();
        for (i, power) in self.powers.iter().enumerate() {
            work.add(h * self.tableau.weight(i), power);
        }
        work
    }
}

impl<E: Equations> Stepper<E> for Esdirk {
    fn step(&mut self, system: &mut System<E>, from: &State, h: f64, to: &mut State) -> StepResult {
        let tableau = self.tableau;
        let last = tableau.stages() - 1;
        let c = tableau.diagonal * h;
        self.stages[0].0.copy_from_slice(&from.v);
        self.stages[0].1.copy_from_slice(&from.a);
        for i in 1..=last {
            self.bases(i, h, from);
            self.predict(i, c, to);
            let stage = ImplicitStage {
                t: from.t + tableau.nodes[i] * h,
                c,
                d: c,
                base_q: &self.base_q,
                base_v: &self.base_v,
            };
            let own = (&mut to.q[..], &mut to.v[..], &mut to.a[..]);
            self.powers[i] = self.newton.solve(system, &stage, own)?;
            if i < last {
                self.stages[i].0.copy_from_slice(&to.v);
                self.stages[i].1.copy_from_slice(&to.a);
            }
        }
        to.t = from.t + h;
        self.estimate(h, to);
        let error = system.equations.error_norm(&self.error);
        let work = self.work(h);
        Ok(TimeStep { error, work })
    }

    fn accept(&mut self, _: &E, _: &State) {
        // the powers at this step's end are those at the next one's start
        self.powers[0] = self.powers[self.tableau.stages() - 1];
    }

    fn stages(&self) -> Option<Stages<'_>> {
        Some(Stages {
            tableau: self.tableau,
            rates: &self.stages,
        })
    }

    fn error_order(&self) -> f64 {
        self.tableau.error_order
    }
}
