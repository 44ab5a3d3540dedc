//! Forward sensitivity of a run: an observer that differentiates each step and sample after the run has
//! computed it.
mod read;
mod step;

use super::active::Active;
use super::block::{Bases, Block};
use super::column::{Changes, Columns, Derivative, Missing};
use super::differences::Difference;
use super::linearized::Linearized;
use super::plan::{Plan, Way};
use super::side::Side;
use super::source::add;
use crate::integrator::method::Method;
use crate::integrator::stepper::Stages;
use crate::linear::Lanes;
use crate::model::description::RopeLaw;
use crate::model::{Individual, Machine, Scratch};
use crate::observe::{Gradient, TorqueBy};
use crate::run::{Observe, RunResult, RunSettings};
use crate::system::{State, System};
use crate::verdict::Verdict;

/// Simulates one individual and differentiates the run. Verdict, samples and counters are those of
/// [`run::simulate`](crate::run::simulate), bit for bit. A failed run has no columns.
pub fn simulate(
    machine: &Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    plan: &Plan,
    observer: &mut dyn Observe,
) -> (RunResult, Option<Columns>) {
    follow((machine, law), settings, plan, observer, |follower| {
        crate::run::simulate(machine, law, settings, follower)
    })
}

/// Simulates and differentiates one individual on the step grid of another run, with stages solved to
/// rounding; see [`run::simulate_on`](crate::run::simulate_on).
pub fn simulate_on(
    (machine, law): (&Machine, &RopeLaw),
    settings: &RunSettings,
    steps: &[f64],
    plan: &Plan,
    observer: &mut dyn Observe,
) -> (RunResult, Option<Columns>) {
    follow((machine, law), settings, plan, observer, |follower| {
        crate::run::simulate_on(machine, law, settings, steps, follower)
    })
}

fn follow<'a>(
    subject: (&'a Machine, &'a RopeLaw),
    settings: &RunSettings,
    plan: &'a Plan,
    observer: &mut dyn Observe,
    run: impl FnOnce(&mut Follower<'a, '_>) -> RunResult,
) -> (RunResult, Option<Columns>) {
    let mut follower = Follower::new(subject, settings, plan, observer);
    let result = run(&mut follower);
    let columns = (result.verdict == Verdict::Complete).then(|| follower.columns(plan));
    (result, columns)
}

/// Observer that propagates the columns along a run.
struct Follower<'a, 'o> {
    observer: &'o mut dyn Observe,
    settings: RunSettings,
    /// Machine that is simulated.
    own: Side<'a>,
    active: Vec<Active<'a>>,
    blocks: Vec<Block>,
    /// Buffers, allocated at the start of the run.
    room: Option<Room>,
    /// Reason why propagation of the columns has stopped.
    missing: Option<Missing>,
    /// States at both ends of the last step.
    ends: [State; 2],
    /// Gauge readings at each sample, before filters that act on whole curves.
    read: [Vec<f64>; 4],
}

/// Buffers of the sensitivity analysis.
struct Room {
    /// Linearised stages of a step, all of them or one at a time; the first also serves the equilibrium.
    stages: Vec<Linearized>,
    bases: Bases,
    scratch: Scratch,
    right: Vec<Lanes>,
    force: [Vec<f64>; 2],
    state: State,
    /// Analytic derivatives of the stress, if available for the machine.
    gradient: Option<Gradient>,
    torque: TorqueBy,
    factorizations: u64,
}

impl<'a, 'o> Follower<'a, 'o> {
    fn new(
        (machine, law): (&'a Machine, &'a RopeLaw),
        settings: &RunSettings,
        plan: &'a Plan,
        observer: &'o mut dyn Observe,
    ) -> Self {
        let subject = (machine, law);
        let ways = plan.ways.iter().enumerate();
        let mut active: Vec<_> = ways
            .filter_map(|way| Active::new(subject, settings, way))
            .collect();
        active.sort_by_key(Active::order);
        let missing = match settings.method {
            Method::RungeKutta(_) => None,
            Method::Rosenbrock | Method::GeneralizedAlpha { .. } | Method::Bdf { .. } => {
                Some(Missing::Method)
            }
        };
        Self {
            own: Side::new(machine, machine.ropes(law), settings.drive(machine)),
            active,
            settings: *settings,
            observer,
            blocks: Vec::new(),
            room: None,
            missing,
            ends: std::array::from_fn(|_| State::at_rest(0.0, Vec::new())),
            read: [const { Vec::new() }; 4],
        }
    }

    /// Returns the result of each column in the order of the plan.
    fn columns(self, plan: &Plan) -> Columns {
        let missing = self.missing;
        let mut columns: Vec<_> = plan
            .ways
            .iter()
            .map(|way| match way {
                Way::Missing(missing) => Derivative::Missing(*missing),
                Way::Coefficient(_) | Way::Beside { .. } | Way::Pieces(_) | Way::Nothing => {
                    Derivative::Nothing
                }
            })
            .collect();
        for active in self.active {
            columns[active.column] =
                missing.map_or_else(|| judged(active.curves), Derivative::Missing);
        }
        Columns {
            columns,
            factorizations: self.room.map_or(0, |room| room.factorizations),
        }
    }
}

impl Observe for Follower<'_, '_> {
    fn begin(&mut self, system: &mut System<Individual<'_>>, state: &State) {
        self.observer.begin(system, state);
        if let Method::RungeKutta(tableau) = self.settings.method {
            self.missing = self.start(system, state, tableau.stages()).err();
        }
    }

    fn step(
        &mut self,
        system: &mut System<Individual<'_>>,
        ends: [&State; 2],
        stages: Option<Stages<'_>>,
    ) {
        self.observer.step(system, ends, stages);
        if let (None, Some(stages)) = (self.missing, stages) {
            self.missing = self.follow(system, ends, stages).err();
        }
    }

    fn sample(&mut self, index: usize, system: &mut System<Individual<'_>>, state: &State) {
        self.observer.sample(index, system, state);
        if self.missing.is_none() {
            self.read(index, state);
        }
    }

    fn complete(&mut self, machine: &Machine, spacing: f64) {
        self.observer.complete(machine, spacing);
        let filters = |side: &Side<'_>| side.machine.hooks.has_readings();
        let own = filters(&self.own);
        let active = self.active.iter_mut();
        for active in active.filter(|active| own || active.sides.iter().any(filters)) {
            let mut sum =
                [const { Vec::new() }; 4].map(|_: Vec<f64>| vec![0.0; self.read[0].len()]);
            let mut add_series = |side: &Side<'_>, step: f64, share: f64| {
                let mut curves = self.read.clone();
                for (curve, column) in curves.iter_mut().zip(&active.curves.gauge) {
                    add(curve, step, column);
                }
                side.machine.hooks.read_series(spacing, &mut curves);
                for (sum, curve) in sum.iter_mut().zip(&curves) {
                    add(sum, share, curve);
                }
            };
            let Difference {
                steps,
                weights,
                own,
            } = active.difference;
            if own != 0.0 {
                add_series(&self.own, 0.0, own);
            }
            for (k, (step, weight)) in steps.into_iter().zip(weights).enumerate() {
                add_series(active.sides.get(k).unwrap_or(&self.own), step, weight);
            }
            active.curves.gauge = sum;
        }
    }
}

/// Classifies computed curves as zero, finite, or unavailable because of non-finite values.
fn judged(changes: Changes) -> Derivative {
    let all = |is: fn(&f64) -> bool| changes.each().flatten().all(is);
    if all(|x| *x == 0.0) {
        Derivative::Nothing
    } else if all(|x| x.is_finite()) {
        Derivative::Curves(Box::new(changes))
    } else {
        Derivative::Missing(Missing::NotFinite)
    }
}
