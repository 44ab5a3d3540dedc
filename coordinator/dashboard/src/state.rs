//! What is known of a run that is followed: a fold over its journal.
use discrepancy::{
    budget::cost,
    laboratory::{Finding, Stage},
};
use journal::account::{AccountBuilder, Costs, JobCost};
use journal::event::{Asked, Event, Finished};
use journal::{Answers, Damage, describe_damage};
use protocol::{
    id::{JobId, WorkerId},
    job::Outcome,
    wire,
};
use run::manifest::{CALIBRATE, DIAGNOSE, IDENTIFY};
use std::{
    collections::{BTreeMap, BTreeSet},
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
    /// Command that began the run.
    kind: String,
    answers: Answers,
    /// Evaluations of a calibration, and what it simulated for its tables.
    pub(super) reading: CalibrationReader,
    /// Highest generation of an individual that a search requested.
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
    /// Stage of the last request that was not made before.
    pub(super) stage: Option<Stage>,
    /// Jobs of the stages; a later process of the run requests those without a result again.
    stage_jobs: BTreeSet<JobId>,
    /// Interim results of a diagnosis by the numbers of their entries.
    pub(super) findings: BTreeMap<u64, Finding>,
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
            Event::Found { number, entry } => {
                if let Ok(entry) = wire::decode(entry) {
                    self.found(*number, entry);
                }
            }
            Event::Begun { header, .. } => self.kind.clone_from(&header.kind),
            Event::Proved { .. } | Event::Accounted(_) => {}
        }
        if !self.is_calibration() && !self.has_stages() {
            return;
        }
        if let Some((asked, finished)) = self.answers.pair(event) {
            let stage = self.stage_of(&asked);
            if let Some(stage) = stage.and_then(|stage| self.stages.get_mut(&stage)) {
                stage.done += 1;
            }
            if self.is_calibration() {
                self.reading.answer(asked, finished);
            }
        }
    }

    fn is_calibration(&self) -> bool {
        self.kind == CALIBRATE
    }

    fn has_stages(&self) -> bool {
        [DIAGNOSE, IDENTIFY].contains(&self.kind.as_str())
    }

    /// Returns the stage of a diagnosis or identification that requested a job; `None` for other jobs.
    fn stage_of(&self, asked: &Asked) -> Option<Stage> {
        let all = Stage::ALL.into_iter().filter(|_| self.has_stages());
        let mut of_job = all.filter(|stage| stage.name() == asked.reason.purpose);
        of_job.next()
    }

    fn asked(&mut self, asked: &Asked) {
        if let Some(stage) = self.stage_of(asked)
            && self.stage_jobs.insert(asked.job)
        {
            let own = self.stages.entry(stage).or_default();
            own.asked += 1;
            own.spent += cost(asked.columns as usize);
            self.stage = Some(stage);
        }
        let generation = asked.reason.generation.unwrap_or_default();
        self.generation = self.generation.max(generation);
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

    fn found(&mut self, number: u64, entry: Entry) {
        match entry {
            Entry::Planned {
                generations,
                evaluations,
            } => self.plan = (generations, evaluations),
            Entry::Budgeted(budget) => self.budget = budget,
            Entry::Interim(finding) => drop(self.findings.insert(number, finding)),
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

#[cfg(test)]
mod tests {
    use super::*;
    use journal::event::{JobReason, RunHeader};
    use protocol::{
        id::{AttemptId, ContentHash, RunId},
        job::{Failure, Job},
        message::{Attempt, Cost},
    };

    fn begun(kind: &str) -> RunState {
        let mut state = RunState::default();
        state.event(Event::Begun {
            run: RunId(1),
            header: RunHeader {
                kind: kind.to_owned(),
                case: ContentHash::of(&[]),
                settings: String::new(),
            },
        });
        state
    }

    fn asked(job: u64, purpose: &str, generation: Option<u32>) -> Event {
        let own = Job::Nothing {
            payload: Vec::new(),
            reply_bytes: 0,
            delay_ms: 0,
        };
        let reason = JobReason {
            purpose: purpose.to_owned(),
            generation,
        };
        Event::Asked(Box::new(Asked::new(JobId(job), &own, reason)))
    }

    fn finished(job: u64) -> Event {
        Event::Finished(Box::new(Finished {
            attempt: Attempt {
                job: JobId(job),
                attempt: AttemptId::COORDINATOR,
            },
            work: ContentHash::of(&[]),
            worker: None,
            cost: Cost::default(),
            outcome: Outcome::Failed(Failure::Refused {
                reason: "gone".to_owned(),
            }),
        }))
    }

    fn interim(number: u64, gap: f64) -> Event {
        let finding = Finding {
            added: Vec::new(),
            gap,
            suspects: Vec::new(),
        };
        let entry = wire::encode(&Entry::Interim(finding)).unwrap();
        Event::Found {
            number,
            entry: entry.into(),
        }
    }

    #[test]
    fn a_job_that_is_requested_again_counts_once() {
        let mut state = begun(DIAGNOSE);
        for job in [1, 2, 1] {
            state.event(asked(job, Stage::Test.name(), None));
        }
        state.event(asked(3, Stage::Refit.name(), None));
        state.event(asked(2, Stage::Test.name(), None));
        state.event(finished(1));
        let test = state.stages[&Stage::Test];
        assert_eq!((test.asked, test.done), (2, 1));
        assert_eq!(state.stage, Some(Stage::Refit));
    }

    #[test]
    fn entries_stand_in_the_order_of_their_numbers_and_generations_do_not_fall() {
        let mut state = begun(DIAGNOSE);
        state.event(interim(5, 0.1));
        state.event(interim(4, 0.5));
        let gaps: Vec<f64> = state.findings.values().map(|own| own.gap).collect();
        assert_eq!(gaps, [0.5, 0.1]);
        let mut state = begun(CALIBRATE);
        state.event(asked(7, "mutate", Some(3)));
        state.event(asked(2, "mutate", Some(0)));
        assert_eq!(state.generation, 3);
    }

    #[test]
    fn results_of_a_sweep_are_counted_and_not_kept() {
        let mut state = begun("sweep");
        state.event(asked(1 << 41, "score", None));
        state.event(finished(1 << 41));
        assert_eq!((state.results, state.answers.results()), (1, 0));
    }
}
