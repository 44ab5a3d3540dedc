//! Derivatives of whole runs of a small machine compared with dual numbers: an independent implementation of
//! the equations uses numbers that carry the derivative with respect to one coefficient, and the stages of
//! the integration method are differentiated with a dense matrix that these numbers give column by column.
//!
//! Both are derivatives at the run's own states, so they agree up to rounding.
mod machine;
mod number;

use crate::rope::recommended;
use machine::{DualMachine, Motion};
use nalgebra::{DMatrix, DVector};
use number::Dual;
use simulation::integrator::dense::interpolate;
use simulation::integrator::stepper::Stages;
use simulation::model::{Machine, RopeMachine};
use simulation::reference;
use simulation::run::{Observe, RunSettings};
use simulation::sensitivity::{
    self, Coefficient, Column, ColumnOrigin, Derivative, DerivativePlan,
};
use simulation::system::{State, System};

/// Observer of a run that integrates the derivatives with respect to one coefficient through the stages of
/// each step.
struct Follower<'a> {
    machine: &'a Machine,
    twin: DualMachine<'a>,
    /// Derivatives of the states at the start and at the end of the last step.
    ends: [State; 2],
    /// Derivatives of the suspension's height and of the crank torque at each sample.
    curves: [Vec<f64>; 2],
}

fn dual(real: [&[f64]; 3], by: &[Vec<f64>; 3]) -> Motion {
    std::array::from_fn(|part| {
        let pairs = real[part].iter().zip(&by[part]);
        pairs.map(|(x, by)| Dual(*x, *by)).collect()
    })
}

impl Follower<'_> {
    /// Solves for the derivatives of coordinates, rates and accelerations that keep the residual zero. Each
    /// of the three is `base` plus its factor in `times` multiplied by the unknown of the coordinate, for
    /// which a linear system is solved.
    fn solve(
        &self,
        system: &mut System<RopeMachine<'_>>,
        (t, real): (f64, [&[f64]; 3]),
        base: [Vec<f64>; 3],
        times: [f64; 3],
    ) -> [Vec<f64>; 3] {
        let drive = system.equations.drive_state(t);
        let n = real[0].len();
        let free = (0..n).filter(|k| !self.machine.layout.is_locked(*k));
        let free: Vec<usize> = free.collect();
        let residual = |by: &[Vec<f64>; 3]| {
            let (all, _) = self.twin.residual(&drive, &dual(real, by));
            DVector::from_iterator(free.len(), free.iter().map(|k| all[*k].1))
        };
        let none = || std::array::from_fn(|_| vec![0.0; n]);
        let by_parameter = residual(&none());
        let columns = free.iter().map(|&k| {
            let mut seed: [Vec<f64>; 3] = none();
            for (seed, times) in seed.iter_mut().zip(times) {
                seed[k] = times;
            }
            residual(&seed) - &by_parameter
        });
        let columns: Vec<_> = columns.collect();
        let factor = DMatrix::from_columns(&columns).lu();
        let right = factor.solve(&residual(&base)).unwrap();
        let mut by = base;
        for (by, times) in by.iter_mut().zip(times) {
            for (k, x) in free.iter().zip(&right) {
                by[*k] -= times * x;
            }
        }
        by
    }
}

impl Observe for Follower<'_> {
    fn begin(&mut self, system: &mut System<RopeMachine<'_>>, state: &State) {
        let zeros = vec![0.0; state.q.len()];
        let real = [&state.q[..], &zeros, &zeros];
        let none = std::array::from_fn(|_| zeros.clone());
        let [q, ..] = self.solve(system, (state.t, real), none, [1.0, 0.0, 0.0]);
        self.ends[1] = State::at_rest(state.t, q);
    }

    fn step(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        [from, to]: [&State; 2],
        stages: Option<Stages<'_>>,
    ) {
        let Stages { tableau, rates } = stages.unwrap();
        let h = to.t - from.t;
        let c = tableau.diagonal * h;
        self.ends.swap(0, 1);
        let start = self.ends[0].clone();
        let mut each = vec![[start.q.clone(), start.v.clone(), start.a.clone()]];
        let along = |first: &[f64], rates: &[&[f64]], row: &[f64]| -> Vec<f64> {
            let mut sum = first.to_vec();
            for (weight, rate) in row.iter().zip(rates) {
                for (sum, rate) in sum.iter_mut().zip(*rate) {
                    *sum += h * weight * rate;
                }
            }
            sum
        };
        for i in 1..tableau.stages() {
            let (v, a) = rates.get(i).map_or((&to.v, &to.a), |(v, a)| (v, a));
            let mut passed: Vec<&[f64]> = rates[..i].iter().map(|(v, _)| &v[..]).collect();
            passed.push(v);
            let row = [&tableau.rows[i][..i], &[tableau.diagonal]].concat();
            let q = along(&from.q, &passed, &row);
            let part = |k: usize| each.iter().map(|by| &by[k][..]).collect::<Vec<_>>();
            let base_v = along(&start.v, &part(2), &row[..i]);
            let base_q = along(&start.q, &part(1), &row[..i]);
            let base_q = base_q.iter().zip(&base_v).map(|(q, v)| q + c * v);
            let base = [base_q.collect(), base_v, vec![0.0; q.len()]];
            let at = (from.t + tableau.nodes[i] * h, [&q[..], v, a]);
            let by = self.solve(system, at, base, [c * c, c, 1.0]);
            each.push(by);
        }
        if let Some([q, v, a]) = each.pop() {
            self.ends[1] = State { t: to.t, q, v, a };
        }
        self.ends[0].t = from.t;
    }

    fn sample(&mut self, _: usize, system: &mut System<RopeMachine<'_>>, state: &State) {
        let mut by = state.clone();
        let [from, to] = &self.ends;
        interpolate(from, to, state.t, &mut by);
        let height = by.q[self.machine.layout.suspension()];
        let drive = system.equations.drive_state(state.t);
        let motion = dual([&state.q, &state.v, &state.a], &[by.q, by.v, by.a]);
        let (_, torque) = self.twin.residual(&drive, &motion);
        for (curve, x) in self.curves.iter_mut().zip([height, torque.1]) {
            curve.push(x);
        }
    }
}

/// Checks the derivatives of height and torque by each coefficient against dual numbers, for a rigid head, a
/// sixth of the cylinders and three times the speed (measured: agreement to 2e-13 in height and to 3e-7 in
/// torque, whose derivatives by the state are obtained by differences).
#[test]
fn columns_are_what_dual_numbers_say() {
    let mut description = reference::description();
    description.crank.speed *= 3.0;
    description.rope.pitch *= 6.0;
    description.rope.back /= 6;
    description.rope.front /= 6;
    let machine = Machine::new(description.clone(), 0).unwrap();
    let origin = ColumnOrigin {
        description: &description,
        modes: 0,
        effects: &[],
    };
    let settings = RunSettings {
        lead_in: 20_f64.to_radians(),
        ramp: 0.3,
        samples: 72,
        ..RunSettings::default()
    };
    let law = recommended();
    for by in Coefficient::ALL {
        let plan = DerivativePlan::new(&origin, &machine, &[Column::Coefficient(by)]).unwrap();
        let mut follower = Follower {
            machine: &machine,
            twin: DualMachine::new(&machine, &law, by),
            ends: std::array::from_fn(|_| State::at_rest(0.0, Vec::new())),
            curves: [Vec::new(), Vec::new()],
        };
        let run = sensitivity::simulate(&machine, &law, &settings, &plan, &mut follower);
        let found = match &run.1.unwrap().columns[0] {
            Derivative::Curves(curves) => [curves.suspension.clone(), curves.torque.clone()],
            Derivative::Zero => [vec![0.0; 72], vec![0.0; 72]],
            Derivative::Missing(missing) => unreachable!("{by:?}: {missing}"),
        };
        let pairs = found.iter().zip(&follower.curves);
        for ((found, expected), share) in pairs.zip([1e-10, 3e-6]) {
            let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            let pairs = found.iter().zip(expected);
            let apart = pairs.fold(0.0_f64, |apart, (x, y)| apart.max((x - y).abs()));
            println!("{by:?}: {largest:e}, apart {apart:e}");
            assert_eq!(found.len(), expected.len());
            assert!(apart <= share * largest, "{by:?}");
        }
    }
}
