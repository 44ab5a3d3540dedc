//! What is known of a run that is followed: a fold over its journal and over the study that is repeated on it.
use discrepancy::laboratory::Finding;
use journal::account::{AccountBuilder, Costs, JobCost};
use journal::event::{Event, Finished};
use journal::{Damage, Growth, JournalEntry, describe_damage};
use protocol::{
    id::WorkerId,
    job::{Answer, Curves, Evaluation, Job, Outcome, Reply},
};
use std::{
    collections::BTreeMap,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
};
use study::{FollowObserver, LogEntry, ProgressView, Snapshot, StageView, Watch};

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

/// Score and curves of one individual under one condition, as far as they have arrived.
#[derive(Clone, Debug, Default)]
pub(super) struct Shown {
    pub(super) evaluation: Option<Evaluation>,
    pub(super) curves: Option<Curves>,
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
    pub(super) history: BTreeMap<u64, LogEntry>,
    pub(super) costs: Costs,
    pub(super) account: AccountBuilder,
    pub(super) workers: BTreeMap<WorkerId, WorkerState>,
    pub(super) progress: ProgressView,
    /// Last progress of each stage of a diagnosis or identification, in order.
    pub(super) stages: Vec<StageView>,
    /// Interim results of a diagnosis, in order.
    pub(super) findings: Vec<Finding>,
    pub(super) notes: Vec<String>,
    /// Individuals that the run simulates for its tables, by the bits of their values and the condition.
    pub(super) shown: BTreeMap<(Vec<u64>, usize), Shown>,
}

impl RunState {
    /// Returns the log entry of the best individual whose simulation was complete.
    pub(super) fn best(&self) -> Option<&LogEntry> {
        let complete = |entry: &&LogEntry| entry.ending.failure().is_none();
        let entries = self.history.values().filter(complete);
        entries.min_by(|a, b| a.fitness.total_cmp(&b.fitness))
    }

    fn event(&mut self, event: &Event) {
        self.account.apply(event);
        match event {
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
            Event::Finished(finished) => {
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
            Event::Begun { .. }
            | Event::Asked(_)
            | Event::Found { .. }
            | Event::Proved { .. }
            | Event::Accounted(_) => {}
        }
    }

    fn result(&mut self, job: &Job, finished: &Finished) {
        let (Job::Simulate(spec), Outcome::Done(answer)) = (job, &finished.outcome) else {
            return;
        };
        let bits = spec.individual.genes.iter().map(|gene| gene.to_bits());
        let key = (bits.collect(), spec.individual.condition);
        match (answer, &spec.reply) {
            (Answer::Curves(curves), Reply::Curves { .. }) => {
                self.shown.entry(key).or_default().curves = Some((**curves).clone());
            }
            (Answer::Scored(evaluation), Reply::Score { whole: false, .. }) => {
                self.shown.entry(key).or_default().evaluation = Some(evaluation.clone());
            }
            _ => {}
        }
    }

    fn stage(&mut self, view: &StageView) {
        match self.stages.iter_mut().find(|old| old.stage == view.stage) {
            Some(old) => *old = *view,
            None => self.stages.push(*view),
        }
    }
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

impl FollowObserver for SharedState {
    fn event(&mut self, _entry: JournalEntry, event: &Event) {
        self.change(|state| state.event(event));
    }

    fn result(&mut self, job: &Job, finished: &Finished) {
        self.change(|state| state.result(job, finished));
    }

    fn read(&mut self, growth: Growth, _position: u64, damage: &[Damage]) {
        if growth == Growth::Grown {
            self.change(|state| {
                state.damage = describe_damage(damage);
            });
        }
    }
}

impl Watch<ProgressView> for SharedState {
    fn progress(&mut self, view: &ProgressView, _: &dyn Fn() -> Snapshot) {
        self.change(|state| state.progress = view.clone());
    }

    fn entered(&mut self, entry: &LogEntry) {
        self.change(|state| drop(state.history.insert(entry.id, entry.clone())));
    }

    fn noted(&mut self, notes: &[String]) {
        self.change(|state| state.notes = notes.to_vec());
    }
}

impl Watch<StageView> for SharedState {
    fn progress(&mut self, view: &StageView, _: &dyn Fn() -> Snapshot) {
        self.change(|state| state.stage(view));
    }

    fn entered(&mut self, finding: &Finding) {
        self.change(|state| state.findings.push(finding.clone()));
    }

    fn noted(&mut self, notes: &[String]) {
        self.change(|state| state.notes = notes.to_vec());
    }
}
