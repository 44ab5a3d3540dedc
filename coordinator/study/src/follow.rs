//! Evaluator that computes nothing and answers a study's jobs from the journal of a run that goes on.
//!
//! A study on this evaluator repeats the run as its results arrive, knows everything that the run's own study
//! knows, and changes nothing in the run folder.
use super::{error::EvaluatorError, evaluator::Evaluator};
use dispatch::scheduler::{Completed, Snapshot};
use journal::event::{Event, Finished, JobReason};
use journal::{Damage, Growth, JournalEntry, JournalFollower};
use protocol::{id::JobId, job::Job};
use std::{
    collections::{BTreeMap, VecDeque},
    path::Path,
    time::Duration,
};

/// Interval at which the journal is read while the study waits for a result.
const INTERVAL: Duration = Duration::from_millis(150);

/// Observer of what a [`FollowingEvaluator`] reads.
pub trait FollowObserver {
    /// Receives each event of the journal, in order.
    fn event(&mut self, _entry: JournalEntry, _event: &Event) {}

    /// Receives each job of the study with its result, before the study does.
    fn result(&mut self, _job: &Job, _finished: &Finished) {}

    /// Receives the state of the journal after each reading: its growth, the offset up to which it was read
    /// (bytes), and the stretches that cannot be read.
    fn read(&mut self, _growth: Growth, _position: u64, _damage: &[Damage]) {}
}

/// Evaluator that returns the results of a growing journal in the order in which they are written.
pub struct FollowingEvaluator<'a, O> {
    journal: JournalFollower,
    observer: &'a mut O,
    open: BTreeMap<JobId, Job>,
    /// Submitted jobs whose results are in the journal.
    ready: VecDeque<JobId>,
}

impl<'a, O: FollowObserver> FollowingEvaluator<'a, O> {
    /// Creates an evaluator that follows a journal, which need not exist yet.
    pub fn new(journal: &Path, observer: &'a mut O) -> Self {
        Self {
            journal: JournalFollower::new(journal),
            observer,
            open: BTreeMap::new(),
            ready: VecDeque::new(),
        }
    }

    /// Reads what was appended to the journal.
    fn read(&mut self) -> Result<(), EvaluatorError> {
        let had_begun = self.journal.position() > 0;
        let (open, ready, observer) = (&self.open, &mut self.ready, &mut *self.observer);
        let growth = self.journal.read(|entry, event| {
            if let Event::Finished(finished) = event
                && open.contains_key(&finished.job())
            {
                ready.push_back(finished.job());
            }
            observer.event(entry, event);
        });
        let growth = growth.map_err(|error| failed(&error))?;
        self.observer
            .read(growth, self.journal.position(), self.journal.damage());
        match growth {
            Growth::Missing if had_begun => Err(failed(&"the run folder was deleted")),
            Growth::Replaced => Err(failed(&"the journal was replaced by another one")),
            Growth::Missing | Growth::Grown | Growth::Unchanged => Ok(()),
        }
    }

    fn result(&mut self, id: JobId) -> Result<Option<Completed>, EvaluatorError> {
        let found = self.journal.recall(id).map_err(|error| failed(&error))?;
        // a second result of the same job, which counts no more
        let (Some(finished), Some(job)) = (found, self.open.remove(&id)) else {
            return Ok(None);
        };
        if finished.work != job.work_hash() {
            return Err(failed(&format_args!(
                "job {id} of the journal differs from the job that the settings of the run produce"
            )));
        }
        self.observer.result(&job, &finished);
        Ok(Some(Completed {
            id,
            cost: finished.cost,
            outcome: finished.outcome,
            replayed: true,
        }))
    }
}

fn failed(error: &dyn std::fmt::Display) -> EvaluatorError {
    EvaluatorError {
        message: error.to_string(),
        help: None,
        may_go_on: false,
    }
}

impl<O: FollowObserver> Evaluator for FollowingEvaluator<'_, O> {
    fn submit(&mut self, id: JobId, job: Job, _reason: JobReason) -> Result<(), EvaluatorError> {
        if self.journal.has_result(id) {
            self.ready.push_back(id);
        }
        self.open.insert(id, job);
        Ok(())
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        loop {
            while let Some(id) = self.ready.pop_front() {
                if let Some(completed) = self.result(id)? {
                    return Ok(completed);
                }
            }
            self.read()?;
            if self.ready.is_empty() {
                tokio::time::sleep(INTERVAL).await;
            }
        }
    }

    fn snapshot(&self) -> Snapshot {
        Snapshot::default()
    }
}
