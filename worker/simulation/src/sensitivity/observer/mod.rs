//! Forward sensitivity of a run: an observer that differentiates each step and each sample of the run.
mod read;
mod step;

use super::active::Active;
use super::block::{Block, StagePredictor};
use super::column::{Columns, Derivative, DerivativeCurves, Unavailable};
use super::differences::Difference;
use super::linearized::Linearized;
use super::memory::MemoryColumns;
use super::perturbed::PerturbedModel;
use super::plan::{ColumnMethod, DerivativePlan};
use crate::integrator::stepper::Stages;
use crate::linear::Lanes;
use crate::math::vector::add_scaled;
use crate::model::description::RopeLaw;
use crate::model::{ForceBuffers, Machine, RopeMachine};
use crate::observe::{Gradient, TorqueBy};
use crate::run::{Observe, RunResult, RunSettings};
use crate::system::{State, System};
use crate::verdict::Verdict;

/// Simulates one individual and differentiates the run. Verdict, samples and counters are those of
/// [`run::simulate`](crate::run::simulate), bit for bit. A failed run has no derivatives.
pub fn simulate(
    machine: &Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    plan: &DerivativePlan,
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
    plan: &DerivativePlan,
    observer: &mut dyn Observe,
) -> (RunResult, Option<Columns>) {
    follow((machine, law), settings, plan, observer, |follower| {
        crate::run::simulate_on(machine, law, settings, steps, follower)
    })
}

fn follow<'a>(
    subject: (&'a Machine, &'a RopeLaw),
    settings: &RunSettings,
    plan: &'a DerivativePlan,
    observer: &mut dyn Observe,
    run: impl FnOnce(&mut SensitivityObserver<'a, '_>) -> RunResult,
) -> (RunResult, Option<Columns>) {
    let mut follower = SensitivityObserver::new(subject, settings, plan, observer);
    let result = run(&mut follower);
    let columns = (result.verdict == Verdict::Complete).then(|| follower.columns(plan));
    (result, columns)
}

/// Observer that propagates the columns (derivatives) along a run.
struct SensitivityObserver<'a, 'o> {
    observer: &'o mut dyn Observe,
    settings: RunSettings,
    /// Machine whose run is simulated and differentiated.
    own: PerturbedModel<'a>,
    active: Vec<Active<'a>>,
    blocks: Vec<Block>,
    /// Derivatives of the memory of axial laws, one element per block.
    memories: Vec<MemoryColumns>,
    /// Whether the memory of axial laws is still that of the start of the last step, at which the samples within the
    /// step are read.
    memory_behind: bool,
    /// Buffers of the sensitivity analysis; `None` until the run starts.
    room: Option<Workspace>,
    /// Reason why the derivatives could not be propagated to the end; `None` while they can.
    missing: Option<Unavailable>,
    /// States at the start and at the end of the last step.
    ends: [State; 2],
    /// Gauge readings at each sample, before stages of the measuring chain that act on whole curves.
    readings: [Vec<f64>; 4],
}

/// Buffers of the sensitivity analysis.
struct Workspace {
    /// Linearised stages of a step: all of them, or one that is reused; the first also serves the static
    /// equilibrium.
    stages: Vec<Linearized>,
    bases: StagePredictor,
    scratch: ForceBuffers,
    right: Vec<Lanes>,
    force: [Vec<f64>; 2],
    state: State,
    /// Analytic derivatives of the stress, if available for the machine.
    gradient: Option<Gradient>,
    torque: TorqueBy,
    factorizations: u64,
}

impl<'a, 'o> SensitivityObserver<'a, 'o> {
    fn new(
        (machine, law): (&'a Machine, &'a RopeLaw),
        settings: &RunSettings,
        plan: &'a DerivativePlan,
        observer: &'o mut dyn Observe,
    ) -> Self {
        let subject = (machine, law);
        let methods = plan.methods.iter().enumerate();
        let mut active: Vec<_> = methods
            .filter_map(|method| Active::new(subject, settings, method))
            .collect();
        active.sort_by_key(Active::order);
        let is_runge_kutta = settings.method.tableau().is_some();
        let missing = (!is_runge_kutta).then_some(Unavailable::Method);
        Self {
            own: PerturbedModel::new(machine, machine.ropes(law), settings.drive(machine)),
            active,
            settings: *settings,
            observer,
            blocks: Vec::new(),
            memories: Vec::new(),
            memory_behind: false,
            room: None,
            missing,
            ends: std::array::from_fn(|_| State::at_rest(0.0, Vec::new())),
            readings: [const { Vec::new() }; 4],
        }
    }

    /// Returns the derivatives (curves, zero or unavailable) with respect to all unknowns, in the order of
    /// the plan.
    fn columns(self, plan: &DerivativePlan) -> Columns {
        let missing = self.missing;
        let mut columns: Vec<_> = plan
            .methods
            .iter()
            .map(|method| match method {
                ColumnMethod::Missing(missing) => Derivative::Missing(*missing),
                ColumnMethod::Coefficient(_)
                | ColumnMethod::Difference { .. }
                | ColumnMethod::Pieces(_)
                | ColumnMethod::Nothing => Derivative::Zero,
            })
            .collect();
        for active in self.active {
            columns[active.column] =
                missing.map_or_else(|| classify(active.curves), Derivative::Missing);
        }
        Columns {
            columns,
            factorizations: self.room.map_or(0, |room| room.factorizations),
        }
    }
}

impl Observe for SensitivityObserver<'_, '_> {
    fn begin(&mut self, system: &mut System<RopeMachine<'_>>, state: &State) {
        self.observer.begin(system, state);
        if let Some(tableau) = self.settings.method.tableau() {
            self.missing = self.start(system, state, tableau.stages()).err();
        }
    }

    fn step(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        ends: [&State; 2],
        stages: Option<Stages<'_>>,
    ) {
        self.observer.step(system, ends, stages);
        if let (None, Some(stages)) = (self.missing, stages) {
            self.missing = self.propagate(system, ends, stages).err();
        }
    }

    fn sample(&mut self, index: usize, system: &mut System<RopeMachine<'_>>, state: &State) {
        self.observer.sample(index, system, state);
        if self.missing.is_none() {
            self.record(index, state);
        }
    }

    fn complete(&mut self, machine: &Machine, spacing: f64) {
        self.observer.complete(machine, spacing);
        let filters = |side: &PerturbedModel<'_>| side.machine.extensions.has_readings();
        let own = filters(&self.own);
        let active = self.active.iter_mut();
        for active in active.filter(|active| own || active.perturbed.iter().any(filters)) {
            let mut sum =
                [const { Vec::new() }; 4].map(|_: Vec<f64>| vec![0.0; self.readings[0].len()]);
            let mut add_series = |side: &PerturbedModel<'_>, step: f64, share: f64| {
                let mut curves = self.readings.clone();
                for (curve, column) in curves.iter_mut().zip(&active.curves.gauge) {
                    add_scaled(curve, step, column);
                }
                side.machine.extensions.read_series(spacing, &mut curves);
                for (sum, curve) in sum.iter_mut().zip(&curves) {
                    add_scaled(sum, share, curve);
                }
            };
            // amplitudes of generic forces have no machines by whose step the readings would differ
            let displaced = active.perturbed.is_empty().then(|| {
                let by = active.curves.gauge.iter().flatten();
                Difference::displacing(self.readings.iter().flatten(), by)
            });
            let Difference {
                steps,
                weights,
                own,
            } = displaced.flatten().unwrap_or(active.difference);
            if own != 0.0 {
                add_series(&self.own, 0.0, own);
            }
            for (k, (step, weight)) in steps.into_iter().zip(weights).enumerate() {
                add_series(active.perturbed.get(k).unwrap_or(&self.own), step, weight);
            }
            active.curves.gauge = sum;
        }
    }
}

/// Classifies computed derivative curves as zero, finite, or unavailable because of non-finite values.
fn classify(changes: DerivativeCurves) -> Derivative {
    let all = |is: fn(&f64) -> bool| changes.each().flatten().all(is);
    if all(|x| *x == 0.0) {
        Derivative::Zero
    } else if all(|x| x.is_finite()) {
        Derivative::Curves(Box::new(changes))
    } else {
        Derivative::Missing(Unavailable::NotFinite)
    }
}
