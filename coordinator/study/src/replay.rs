//! Evaluator that computes nothing and answers a study's jobs from a recorded journal.
//!
//! A study on this evaluator repeats the run as far as the journal goes, and changes nothing in the run
//! folder.
use super::{
    error::EvaluatorError,
    evaluator::{Evaluator, WorkersSnapshot},
};
use dispatch::scheduler::Completed;
use journal::JournalSnapshot;
use journal::event::{Finished, JobReason};
use protocol::{id::JobId, job::Job};
use std::collections::VecDeque;

/// Callback that receives every replayed job with its recorded result.
type ResultCallback<'a> = &'a mut dyn FnMut(&Job, &Finished) -> Result<(), EvaluatorError>;

/// Evaluator that returns the recorded results of a journal in the order in which jobs are submitted.
pub struct ReplayEvaluator<'a> {
    recording: &'a JournalSnapshot,
    seen: ResultCallback<'a>,
    asked: VecDeque<(JobId, Job)>,
    unknown: u64,
    ended: bool,
}

impl<'a> ReplayEvaluator<'a> {
    /// Creates an evaluator that answers from a recording; `seen` receives every job with its result before
    /// the study does.
    pub const fn new(recording: &'a JournalSnapshot, seen: ResultCallback<'a>) -> Self {
        Self {
            recording,
            seen,
            asked: VecDeque::new(),
            unknown: 0,
            ended: false,
        }
    }

    /// Returns the number of submitted jobs without a result in the recording.
    pub const fn unknown(&self) -> u64 {
        self.unknown
    }

    /// Returns whether the study requested more than the recording holds and could not continue.
    pub const fn ended(&self) -> bool {
        self.ended
    }

    fn result(&mut self, id: JobId, job: &Job) -> Result<Option<Completed>, EvaluatorError> {
        let failed = |error: &dyn std::fmt::Display| EvaluatorError {
            message: error.to_string(),
            help: None,
        };
        let found = self.recording.recall(id);
        let Some(finished) = found.map_err(|error| failed(&error))? else {
            return Ok(None);
        };
        if finished.work != job.work_hash() {
            return Err(failed(&format_args!(
                "job {id} of the journal differs from the job that the settings of the run produce"
            )));
        }
        (self.seen)(job, &finished)?;
        Ok(Some(Completed {
            id,
            cost: finished.cost,
            outcome: finished.outcome,
            replayed: true,
        }))
    }
}

impl Evaluator for ReplayEvaluator<'_> {
    fn submit(&mut self, id: JobId, job: Job, _reason: JobReason) -> Result<(), EvaluatorError> {
        self.asked.push_back((id, job));
        Ok(())
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        while let Some((id, job)) = self.asked.pop_front() {
            if let Some(completed) = self.result(id, &job)? {
                return Ok(completed);
            }
            self.unknown += 1;
        }
        self.ended = true;
        Err(EvaluatorError {
            message:
                "the journal holds no result for the next jobs of this run: the run is incomplete"
                    .to_owned(),
            help: Some("run the command that began this run: it resumes the run".to_owned()),
        })
    }

    fn workers_status(&self) -> WorkersSnapshot {
        WorkersSnapshot::default()
    }
}
