//! TR-BDF2: a trapezoidal stage to `t + (2 - sqrt 2) h`, then BDF2 to `t + h`.
//!
//! One-step, L-stable, second order, stiffly accurate; both implicit stages share the coefficient
//! `c = (1 - sqrt(1/2)) h` and so one factorisation. Embedded third-order error estimate.
//! Source: Bank et al. 1985; Hosea and Shampine, Appl. Numer. Math. 20 (1996) 21-37.
use super::State;
use super::newton::{Newton, NotConverged, Stage};
use crate::model::Powers;
use crate::system::System;

const GAMMA: f64 = 2.0 - std::f64::consts::SQRT_2;
const D: f64 = 0.5 * GAMMA;
const W: f64 = 0.25 * std::f64::consts::SQRT_2;
/// Weights of the result minus those of the embedded third-order formula.
const ERROR: [f64; 3] = [
    W - (1.0 - W) / 3.0,
    W - (3.0 * W + 1.0) / 3.0,
    D - D / 3.0,
];

/// Result of one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// Local error in units of the error norm.
    pub error: f64,
    /// Work done during the step: input, output, dissipated [J].
    pub work: Powers,
}

/// The method with its buffers.
#[derive(Clone, Debug)]
pub struct TrBdf2 {
    newton: Newton,
    middle: State,
    base_q: Vec<f64>,
    base_v: Vec<f64>,
    error: Vec<f64>,
}

impl TrBdf2 {
    /// For `n` coordinates.
    pub fn new(n: usize) -> Self {
        Self {
            newton: Newton::new(n),
            middle: State::at_rest(0.0, vec![0.0; n]),
            base_q: vec![0.0; n],
            base_v: vec![0.0; n],
            error: vec![0.0; n],
        }
    }

    /// One step of size `h` from `from` into `to`. `power` is that of `from`; it is replaced by
    /// that of `to`.
    ///
    /// # Errors
    /// [`NotConverged`] when a stage could not be solved; `to` is then meaningless.
    pub fn step(
        &mut self,
        system: &mut System<'_>,
        from: &State,
        h: f64,
        to: &mut State,
        power: &mut Powers,
    ) -> Result<Step, NotConverged> {
        let n = from.q.len();
        let c = D * h;
        for i in 0..n {
            self.base_q[i] = from.q[i] + c * from.v[i];
            self.base_v[i] = from.v[i] + c * from.a[i];
            self.middle.v[i] = from.v[i] + GAMMA * h * from.a[i];
        }
        self.middle.t = from.t + GAMMA * h;
        let stage = Stage {
            t: self.middle.t,
            c,
            base_q: &self.base_q,
            base_v: &self.base_v,
        };
        let State { q, v, a, .. } = &mut self.middle;
        self.newton.solve(system, &stage, (q, v, a))?;
        let middle = &self.middle;
        let middle_power = system.powers(middle.t, &middle.q, &middle.v, &middle.a);

        for i in 0..n {
            self.base_q[i] = from.q[i] + h * W * (from.v[i] + middle.v[i]);
            self.base_v[i] = from.v[i] + h * W * (from.a[i] + middle.a[i]);
            let a = from.a[i] + (middle.a[i] - from.a[i]) / GAMMA;
            to.v[i] = self.base_v[i] + c * a;
        }
        to.t = from.t + h;
        let stage = Stage {
            t: to.t,
            c,
            base_q: &self.base_q,
            base_v: &self.base_v,
        };
        self.newton
            .solve(system, &stage, (&mut to.q, &mut to.v, &mut to.a))?;
        let end_power = system.powers(to.t, &to.q, &to.v, &to.a);

        for i in 0..n {
            self.error[i] =
                h * (ERROR[0] * from.v[i] + ERROR[1] * middle.v[i] + ERROR[2] * to.v[i]);
        }
        let sum = |of: fn(&Powers) -> f64| {
            h * (W * (of(power) + of(&middle_power)) + D * of(&end_power))
        };
        let work = Powers {
            input: sum(|p| p.input),
            output: sum(|p| p.output),
            dissipated: sum(|p| p.dissipated),
        };
        *power = end_power;
        Ok(Step {
            error: system.error_norm(&self.error),
            work,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn order_conditions_hold() {
        let nodes = [0.0, GAMMA, 1.0];
        let weights = [W, W, D];
        let embedded: Vec<f64> = weights.iter().zip(ERROR).map(|(b, e)| b - e).collect();
        let moment = |b: &[f64], p: i32| -> f64 { b.iter().zip(nodes).map(|(b, c)| b * c.powi(p)).sum() };
        for p in 0..2 {
            assert!((moment(&weights, p) - 1.0 / f64::from(p + 1)).abs() < 1e-15);
        }
        for p in 0..3 {
            assert!((moment(&embedded, p) - 1.0 / f64::from(p + 1)).abs() < 1e-15, "{p}");
        }
        assert!((moment(&weights, 2) - 1.0 / 3.0).abs() > 1e-3);
    }
}
