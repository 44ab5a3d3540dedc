//! What is known of a run that is followed: a fold over its journal.
use discrepancy::{
    baseline::budget::cost,
    laboratory::{Finding, Stage},
};
use journal::account::{AccountBuilder, Costs, JobCost};
use journal::event::{Asked, Event, Finished};
use journal::{Answers, Damage, describe_damage};
use protocol::{id::WorkerId, job::Outcome, wire};
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};
use study::{CalibrationReader, Entry, LogEntry};

/// Worker of a run, as far as the journal tells.
#[derive(Clone, Debug, Default)]
pub(super) struct WorkerState {
    pub(super) host: String,
    pub(super) slots: u32,
    /// Why the worker left; `None` while it is connected.
    pub(super) left: Option<String>,
    /// Number of accepted results.
    pub(super) done: u64,
    /// Number of accepted results that are failures of the infrastructure.
    pub(super) failed: u64,
    /// Time spent on accepted results (s).
    pub(super) busy_s: f64,
}

/// Progress of one stage of a diagnosis or identification.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct StageState {
    /// Number of requested simulations.
    pub(super) asked: u64,
    /// Number of simulations with a result.
    pub(super) done: u64,
    /// Cost of the requested simulations, in simulations without derivatives.
    pub(super) spent: f64,
}

/// What is known of a run.
#[derive(Clone, Debug, Default)]
pub(super) struct RunState {
    /// Number of changes.
    pub(super) version: u64,
    pub(super) damage: Vec<String>,
    /// Whether the last coordinator process ended the run regularly.
    pub(super) closed: bool,
    /// Time at which the last coordinator process began (ms since 1970 UTC).
    pub(super) opened_unix_ms: u64,
    /// Number of results in the journal.
    pub(super) results: u64,
    answers: Answers,
    /// Evaluations of a calibration, and what it simulated for its tables.
    pub(super) reading: CalibrationReader,
    /// Generation of the last individual that a search requested.
    pub(super) generation: u32,
    /// Planned generations and evaluations of a calibration.
    pub(super) plan: (u32, u64),
    pub(super) costs: Costs,
    pub(super) account: AccountBuilder,
    pub(super) workers: BTreeMap<WorkerId, WorkerState>,
    /// Stages of a diagnosis or identification with their budgets, in simulations without derivatives.
    pub(super) budget: Vec<(Stage, f64)>,
    /// Progress of the stages that were begun.
    pub(super) stages: BTreeMap<Stage, StageState>,
    /// Stage of the last request.
    pub(super) stage: Option<Stage>,
    /// Interim results of a diagnosis, in order.
    pub(super) findings: Vec<Finding>,
    pub(super) notes: Vec<String>,
}

impl RunState {
    /// Returns the log entry of the best individual whose simulation was complete.
    pub(super) fn best(&self) -> Option<&LogEntry> {
        let complete = |entry: &&LogEntry| entry.ending.failure().is_none();
        let entries = self.reading.log().entries().filter(complete);
        entries.min_by(|a, b| a.fitness.total_cmp(&b.fitness))
    }

    fn event(&mut self, event: Event) {
        self.account.apply(&event);
        match &event {
            Event::Opened { at_unix_ms, .. } => {
                self.closed = false;
                self.opened_unix_ms = *at_unix_ms;
            }
            Event::Closed => self.closed = true,
            Event::Joined {
                worker,
                host,
                slots,
                ..
            } => {
                let own = self.workers.entry(*worker).or_default();
                own.host.clone_from(host);
                own.slots = *slots;
                own.left = None;
            }
            Event::Left { worker, reason } => {
                self.workers.entry(*worker).or_default().left = Some(reason.clone());
            }
            Event::Asked(asked) => self.asked(asked),
            Event::Finished(finished) => self.finished(finished),
            // one that cannot be read is told of when the run is over
            Event::Found { entry, .. } => {
                if let Ok(entry) = wire::decode(entry) {
                    self.found(entry);
                }
            }
            Event::Begun { .. } | Event::Proved { .. } | Event::Accounted(_) => {}
        }
        if let Some((asked, finished)) = self.answers.pair(event) {
            let stage = stage_of(&asked).and_then(|stage| self.stages.get_mut(&stage));
            if let Some(stage) = stage {
                stage.done += 1;
            }
            self.reading.answer(asked, finished);
        }
    }

    fn asked(&mut self, asked: &Asked) {
        if let Some(stage) = stage_of(asked) {
            let own = self.stages.entry(stage).or_default();
            own.asked += 1;
            own.spent += cost(asked.columns as usize);
            self.stage = Some(stage);
        }
        self.generation = asked.reason.generation.unwrap_or(self.generation);
    }

    fn finished(&mut self, finished: &Finished) {
        self.results += 1;
        self.costs.insert(finished.job().0, JobCost::of(finished));
        let Some(worker) = finished.worker else {
            return;
        };
        let own = self.workers.entry(worker).or_default();
        own.done += 1;
        own.failed += u64::from(matches!(finished.outcome, Outcome::Failed(_)));
        own.busy_s += finished.cost.wall_s();
    }

    fn found(&mut self, entry: Entry) {
        match entry {
            Entry::Planned {
                generations,
                evaluations,
            } => self.plan = (generations, evaluations),
            Entry::Budgeted(budget) => self.budget = budget,
            Entry::Interim(finding) => self.findings.push(finding),
            Entry::Noted(notes) => self.notes = notes,
            Entry::Record(_)
            | Entry::Calibrated { .. }
            | Entry::Estimated(_)
            | Entry::Diagnosed(_)
            | Entry::Identified(_)
            | Entry::Swept(_)
            | Entry::Tested(_)
            | Entry::Table { .. } => {}
        }
    }
}

/// Returns the stage of a diagnosis or identification that requested a job; `None` for other jobs.
fn stage_of(asked: &Asked) -> Option<Stage> {
    let mut all = Stage::ALL.into_iter();
    all.find(|stage| stage.name() == asked.reason.purpose)
}

/// State of a run, shared between the thread that follows it and the one that renders it.
#[derive(Clone, Default)]
pub(super) struct SharedState(Arc<Mutex<RunState>>);

impl SharedState {
    pub(super) fn lock(&self) -> MutexGuard<'_, RunState> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut RunState)) {
        let mut state = self.lock();
        state.version += 1;
        change(&mut state);
    }

    /// Takes the next event of the journal.
    pub(super) fn event(&self, event: Event) {
        self.change(|state| state.event(event));
    }

    /// Takes the stretches of the journal that cannot be read.
    pub(super) fn damage(&self, damage: &[Damage]) {
        self.change(|state| state.damage = describe_damage(damage));
    }

    /// Forgets everything, for a run that begins again.
    pub(super) fn clear(&self) {
        self.change(|state| {
            *state = RunState {
                version: state.version,
                ..RunState::default()
            };
        });
    }
}
