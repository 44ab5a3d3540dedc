//! Generalised-alpha method of Chung and Hulbert (1993): one implicit stage per step, second order, with
//! numerical damping of modes that the step does not resolve.
//!
//! The equations of motion hold at a time between the ends of a step, `M(q_f) a_m = Q(q_f, v_f, t_f)` with
//! `x_f = (1 - alpha_f) x_1 + alpha_f x_0` and `a_m = (1 - alpha_m) a_1 + alpha_m a_0`, where the
//! *algorithmic* acceleration `a_n` is that of the motion at `t_n + (alpha_m - alpha_f) h`. The algorithmic
//! acceleration is internal to the method: a [`State`] carries the acceleration at its own time. When the
//! step size changes, `a_0` is shifted to the time that the new step size implies; without the shift the
//! order would fall to one.
use super::newton::{ImplicitStage, Newton};
use super::stepper::{StepResult, Stepper, TimeStep};
use crate::system::{Equations, Powers, State, System};

/// Generalised-alpha method with its buffers.
#[derive(Clone, Debug)]
pub struct GeneralizedAlpha {
    alpha_m: f64,
    alpha_f: f64,
    beta: f64,
    gamma: f64,
    newton: Newton,
    /// Last accepted step: its size, the algorithmic accelerations at its end, and their rate of change.
    last_accepted: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// Algorithmic accelerations at the start and at the end of the present step.
    ends: [Vec<f64>; 2],
    step: f64,
    /// Input, output and dissipated power at the time where the equations of motion hold, in the last
    /// accepted step and in the present one.
    powers: [Option<Powers>; 2],
    base_q: Vec<f64>,
    base_v: Vec<f64>,
    error: Vec<f64>,
}

impl GeneralizedAlpha {
    /// Creates the method for a spectral radius at infinite frequency (clamped to 0..1), `n` coordinates and
    /// the local error allowed per step.
    pub fn new(spectral_radius: f64, n: usize, tolerance: f64) -> Self {
        let r = spectral_radius.clamp(0.0, 1.0);
        let alpha_m = (2.0 * r - 1.0) / (r + 1.0);
        let alpha_f = r / (r + 1.0);
        let shift = alpha_f - alpha_m;
        Self {
            alpha_m,
            alpha_f,
            beta: 0.25 * (1.0 + shift) * (1.0 + shift),
            gamma: 0.5 + shift,
            newton: Newton::new(n, tolerance),
            last_accepted: None,
            ends: [vec![0.0; n], vec![0.0; n]],
            step: 0.0,
            powers: [None; 2],
            base_q: vec![0.0; n],
            base_v: vec![0.0; n],
            error: vec![0.0; n],
        }
    }

    /// Computes the algorithmic accelerations at the start of a step of size `h`.
    fn start(&mut self, from: &State, h: f64) {
        let Some((before, a, rate)) = &self.last_accepted else {
            self.ends[0].copy_from_slice(&from.a);
            return;
        };
        let moved = (self.alpha_m - self.alpha_f) * (h - before);
        for (k, end) in self.ends[0].iter_mut().enumerate() {
            *end = a[k] + moved * rate[k];
        }
    }

    /// Computes the bases (known parts) of coordinates and rates in the implicit stage; returns the
    /// coefficients with which rate and acceleration enter it.
    fn bases(&mut self, from: &State, h: f64) -> (f64, f64) {
        let (f, m) = (1.0 - self.alpha_f, 1.0 - self.alpha_m);
        let old = self.alpha_m / m;
        let c = h * self.beta / self.gamma;
        let d = f * h * self.gamma / m;
        let by_q = f * h * h * (0.5 - self.beta - self.beta * old);
        let by_v = f * h * (1.0 - self.gamma - self.gamma * old);
        for k in 0..self.base_q.len() {
            let a = self.ends[0][k];
            let v = from.v[k] + by_v * a;
            self.base_v[k] = v;
            self.base_q[k] = from.q[k] + f * h * from.v[k] + by_q * a - c * v;
        }
        (c, d)
    }
}

impl<E: Equations> Stepper<E> for GeneralizedAlpha {
    fn step(&mut self, system: &mut System<E>, from: &State, h: f64, to: &mut State) -> StepResult {
        self.start(from, h);
        let (c, d) = self.bases(from, h);
        let stage = ImplicitStage {
            t: from.t + (1.0 - self.alpha_f) * h,
            c,
            d,
            base_q: &self.base_q,
            base_v: &self.base_v,
        };
        for k in 0..self.base_v.len() {
            to.v[k] = self.base_v[k] + d * self.ends[0][k];
        }
        let own = (&mut to.q[..], &mut to.v[..], &mut to.a[..]);
        let powers = self.newton.solve(system, &stage, own)?;
        // what is not resolved rings from end to end but not where the equations hold, so that the
        // powers there are extrapolated to the middle
        let before = self.powers[0].unwrap_or(powers);
        self.powers[1] = Some(powers);
        let ahead = self.alpha_f - 0.5;
        let mut work = Powers::default();
        work.add(h * (1.0 + ahead), &powers);
        work.add(-h * ahead, &before);
        let shift = self.alpha_f - self.alpha_m;
        // q_1 is q(t_1) up to h^3 q''' times this; a_1 - a_0 is h q'''
        let missing = h * h * (self.beta - 0.5 * shift - 1.0 / 6.0);
        for k in 0..to.q.len() {
            let a0 = self.ends[0][k];
            let a1 = (to.a[k] - self.alpha_m * a0) / (1.0 - self.alpha_m);
            to.q[k] = from.q[k] + h * from.v[k] + h * h * ((0.5 - self.beta) * a0 + self.beta * a1);
            to.v[k] = from.v[k] + h * ((1.0 - self.gamma) * a0 + self.gamma * a1);
            to.a[k] = a1 + shift * (a1 - a0);
            self.error[k] = missing * (a1 - a0);
            self.ends[1][k] = a1;
        }
        to.t = from.t + h;
        self.step = h;
        let local = system.equations.error_norm(&self.error);
        // the equations held before the end: what they still ask for there shows a contact that began
        // in between, and is of higher order than the local error otherwise
        let loads = system.residual(to.motion(), &to.a, &mut self.error);
        loads.solve(&mut self.error);
        let left = system.equations.error_norm(&self.error);
        Ok(TimeStep {
            error: if local >= left { local } else { left },
            work,
        })
    }

    fn accept(&mut self, _: &E, to: &State) {
        let n = to.a.len();
        let (before, a, rate) = self
            .last_accepted
            .get_or_insert_with(|| (0.0, vec![0.0; n], vec![0.0; n]));
        *before = self.step;
        for k in 0..n {
            a[k] = self.ends[1][k];
            rate[k] = (self.ends[1][k] - self.ends[0][k]) / self.step;
        }
        self.powers[0] = self.powers[1];
    }

    fn error_order(&self) -> f64 {
        3.0
    }
}
