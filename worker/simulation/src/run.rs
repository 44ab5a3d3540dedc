//! Simulation of one individual: static equilibrium, lead-in, one recorded revolution.
use crate::drive::Drive;
use crate::integrator::adaptive::{Adaptive, StepUnderflow};
use crate::integrator::dense::interpolate;
use crate::integrator::method::Method;
use crate::integrator::stepper::Stages;
use crate::integrator::tableau::ESDIRK4;
use crate::model::description::RopeLaw;
use crate::model::{Machine, RopeMachine};
use crate::settle::{Damping, equilibrium, overload, swing_rate};
use crate::statistics::Statistics;
use crate::system::{Powers, State, System};
use crate::verdict::{Failure, Limits, Reached, Verdict};
use std::f64::consts::TAU;

/// Settings of a run: start, integration and sampling.
#[derive(Clone, Copy, Debug)]
pub struct RunSettings {
    /// Integration method.
    pub method: Method,
    /// Turn angle before bottom dead centre at which the crank starts \[rad\].
    pub lead_in: f64,
    /// Duration of the crank's run-up to full speed \[s\].
    pub ramp: f64,
    /// Number of samples over the recorded revolution.
    pub samples: usize,
    /// Tolerated local error per time step, as a multiple of the built-in tolerances of the coordinates.
    pub tolerance: f64,
    /// Longest time step \[s\] while the swing of the beam on its ropes is slow; it determines how well
    /// vibrations of the ropes are resolved.
    pub longest_step: f64,
    /// Natural frequency of the beam's swing on its ropes ([`swing_rate`]) above which the longest step
    /// shrinks in inverse proportion [rad/s]; infinite for a constant longest step.
    pub slow_swing: f64,
    /// Maximum number of Newton iterations of a run.
    pub budget: u64,
    /// Number of Newton iterations of the budget available from the start; the rest is released in proportion
    /// to the simulated time. A run that stalls in chatter thus ends early.
    pub head_start: u64,
    /// Limits of motion beyond which the run ends as failed.
    pub limits: Limits,
    /// Damping of the steps of the equilibrium solver; results do not depend on it.
    pub damping: Damping,
}

/// Default of `slow_swing` [rad/s]: 2.65 Hz, at which a step of 0.06 s is 1/6.3 of a period. The error of the
/// fourth-order method, at the gauge with the largest error, is then 0.12 % of the gauge's range in the
/// median and 0.67 % at most (README).
const SLOW_SWING: f64 = 16.65;

impl Default for RunSettings {
    fn default() -> Self {
        Self {
            method: Method::RungeKutta(&ESDIRK4),
            lead_in: TAU / 6.0,
            ramp: 1.5,
            samples: 720,
            tolerance: 1.0,
            longest_step: 0.05,
            slow_swing: SLOW_SWING,
            budget: 25_000,
            head_start: 4_000,
            limits: Limits::default(),
            damping: Damping::default(),
        }
    }
}

impl RunSettings {
    /// Returns crank motion and load over time, including the run-up of the crank to full speed.
    pub(crate) fn drive(&self, machine: &Machine) -> Drive {
        Drive {
            start: -self.lead_in + machine.extensions.index_offset().min(0.0),
            ramp: self.ramp,
            speed: machine.description.crank.speed,
        }
    }

    pub(crate) fn sampled(&self, machine: &Machine, drive: &Drive, sample: usize) -> f64 {
        let turn = TAU * sample as f64 / self.samples as f64;
        drive.time_at(machine.extensions.index_offset() + turn)
    }

    /// Returns the number of Newton iterations allowed until the given `fraction` of the run's time has been
    /// simulated.
    fn allowed(&self, fraction: f64) -> f64 {
        let (all, first) = (self.budget as f64, self.head_start as f64);
        first.min(all) + fraction * (all - first).max(0.0)
    }
}

/// Observer of a run: receives every step, and every sample of the recorded revolution.
pub trait Observe {
    /// Receives the static equilibrium from which the run starts, before any motion.
    fn begin(&mut self, _system: &mut System<RopeMachine<'_>>, _state: &State) {}

    /// Called after an accepted step, before axial laws store their memory. The loads held by `system` are
    /// not necessarily those of the step's end.
    fn step(
        &mut self,
        _system: &mut System<RopeMachine<'_>>,
        _ends: [&State; 2],
        _stages: Option<Stages<'_>>,
    ) {
    }

    /// Receives sample `index` of the recorded revolution as the interpolated `state`; the loads held by
    /// `system` are not necessarily those of this state.
    fn sample(&mut self, index: usize, system: &mut System<RopeMachine<'_>>, state: &State);

    /// Receives the end of a completed revolution, whose samples are `spacing` \[s\] apart.
    fn complete(&mut self, _machine: &Machine, _spacing: f64) {}
}

/// Result of a run, apart from its samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RunResult {
    /// Verdict of the run: complete, or the kind of failure.
    pub verdict: Verdict,
    /// Computational cost of the run.
    pub statistics: Statistics,
    /// Work of crank, load and dissipation over the recorded revolution \[J\].
    pub work: Powers,
    /// Increase of kinetic and potential energy over the recorded revolution \[J\].
    pub stored: f64,
}

/// Simulates one individual; never panics and never hangs.
pub fn simulate(
    machine: &Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    observer: &mut dyn Observe,
) -> RunResult {
    run((machine, law), settings, None, observer)
}

/// Simulates one individual on the step grid of another run, given by the end times of its steps \[s\].
/// Stages are solved to rounding, so differences between such runs are free of errors from step-size control
/// and from early termination of Newton's method.
pub fn simulate_on(
    machine: &Machine,
    law: &RopeLaw,
    settings: &RunSettings,
    steps: &[f64],
    observer: &mut dyn Observe,
) -> RunResult {
    let exhausted = RunSettings {
        tolerance: 0.0,
        budget: u64::MAX,
        head_start: u64::MAX,
        ..*settings
    };
    run((machine, law), &exhausted, Some(steps), observer)
}

fn run(
    (machine, law): (&Machine, &RopeLaw),
    settings: &RunSettings,
    steps: Option<&[f64]>,
    observer: &mut dyn Observe,
) -> RunResult {
    let drive = settings.drive(machine);
    let mut system = System::new(RopeMachine::new(machine, machine.ropes(law), drive));
    let swing = machine.swing();
    let start = match settle(&mut system, settings, None) {
        Ok(q) => q,
        Err((kind, fraction)) => {
            return RunResult {
                verdict: Verdict::Failed {
                    kind,
                    reached: Reached::LoadFraction(fraction),
                },
                statistics: system.statistics,
                work: Powers::default(),
                stored: 0.0,
            };
        }
    };
    revolve(&mut system, settings, (swing, steps), start, observer)
}

/// Solves the static equilibrium at time 0; `start` is an initial guess that affects only the cost.
///
/// # Errors
/// The failure at full load, and the share of the load that the machine can carry.
pub fn settle(
    system: &mut System<RopeMachine<'_>>,
    settings: &RunSettings,
    start: Option<&[f64]>,
) -> Result<Vec<f64>, (Failure, f64)> {
    let swing = system.equations.machine.swing();
    let full = system.equations.drive_state(0.0);
    let RopeMachine { machine, ropes, .. } = system.equations;
    if let Some(overload) = overload(machine, &ropes, &full, &settings.limits) {
        return Err(overload);
    }
    let mut attempt = |share: f64| {
        system.equations.scale_load(share);
        equilibrium(system, &settings.limits, swing, &settings.damping, start)
    };
    let kind = match attempt(1.0) {
        Ok(q) => return Ok(q),
        // where no equilibrium is found, less load is no better known
        Err(Failure::Budget) => return Err((Failure::Budget, 0.0)),
        Err(kind) => kind,
    };
    let (mut carried, mut too_much) = (0.0, 1.0);
    for _ in 0..4 {
        let middle = 0.5 * (carried + too_much);
        if attempt(middle).is_ok() {
            carried = middle;
        } else {
            too_much = middle;
        }
    }
    Err((kind, carried))
}

fn revolve(
    system: &mut System<RopeMachine<'_>>,
    settings: &RunSettings,
    (swing, steps): ([f64; 2], Option<&[f64]>),
    start: Vec<f64>,
    observer: &mut dyn Observe,
) -> RunResult {
    let tolerance = settings.tolerance;
    let swings = swing_rate(system, &start).unwrap_or(0.0);
    let longest = settings.longest_step / (swings / settings.slow_swing).max(1.0);
    let mut method = Adaptive::new(settings.method, system, tolerance, longest);
    let mut from = State::at_rest(0.0, start);
    let mut to = from.clone();
    let mut between = from.clone();
    let drive = system.equations.drive;
    let zero = system.equations.machine.extensions.index_offset();
    let (begin, end) = (drive.time_at(zero), drive.time_at(TAU + zero));
    observer.begin(system, &from);
    system.equations.update_memory(&from);
    let mut given = steps.map(<[f64]>::iter);
    let mut sample = 0;
    let mut ledger = Ledger::default();
    let verdict = loop {
        let next = given.as_mut().map(Iterator::next);
        if from.t >= end - 1e-9 || next == Some(None) {
            break Verdict::Complete;
        }
        let fraction = from.t / end;
        let reached = Reached::TimeFraction(fraction);
        let failed = |kind| Verdict::Failed { kind, reached };
        if system.statistics.newton_iterations as f64 > settings.allowed(fraction) {
            break failed(Failure::Budget);
        }
        // stop exactly where the recorded revolution begins and ends
        let stop = if from.t < begin - 1e-9 { begin } else { end };
        let tried = match next.flatten() {
            Some(&given) => method
                .step_without_error_control(system, &from, given, &mut to)
                .map(Some),
            None => method.attempt(system, &from, stop, &mut to),
        };
        let done = match tried {
            Err(StepUnderflow) => break failed(Failure::StepUnderflow),
            Ok(None) => continue,
            Ok(Some(done)) => done,
        };
        if let Some(kind) = settings
            .limits
            .first_exceeded(&system.equations, &to.q, swing)
        {
            break failed(kind);
        }
        ledger.add(
            &mut system.equations,
            [&from, &to],
            &done.work,
            [begin, end],
        );
        observer.step(system, [&from, &to], method.stages());
        while sample < settings.samples {
            let t = settings.sampled(system.equations.machine, &drive, sample);
            if t > to.t + 1e-9 {
                break;
            }
            interpolate(&from, &to, t, &mut between);
            observer.sample(sample, system, &between);
            sample += 1;
        }
        system.equations.update_memory(&to);
        std::mem::swap(&mut from, &mut to);
    };
    if verdict == Verdict::Complete {
        let spacing = TAU / drive.speed / settings.samples as f64;
        observer.complete(system.equations.machine, spacing);
    }
    RunResult {
        verdict,
        statistics: system.statistics,
        work: ledger.work,
        stored: ledger.stored(),
    }
}

/// Energy balance: work and stored energy over the recorded revolution.
#[derive(Clone, Copy, Debug, Default)]
struct Ledger {
    work: Powers,
    first: Option<f64>,
    last: f64,
}

impl Ledger {
    fn add(
        &mut self,
        individual: &mut RopeMachine<'_>,
        [from, to]: [&State; 2],
        work: &Powers,
        [begin, end]: [f64; 2],
    ) {
        if from.t < begin - 1e-9 {
            return;
        }
        if self.first.is_none() {
            self.first = Some(individual.energy(from));
        }
        self.work.add(1.0, work);
        if to.t >= end - 1e-9 {
            self.last = individual.energy(to);
        }
    }

    fn stored(&self) -> f64 {
        self.first.map_or(0.0, |first| self.last - first)
    }
}
