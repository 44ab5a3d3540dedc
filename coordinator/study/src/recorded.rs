//! An evaluator that computes nothing: it knows what a journal holds and nothing else.
//!
//! A study that runs on it takes the path that the run took, as far as the journal goes, and
//! leaves no trace in the run's folder.
use super::{
    error::EvaluatorError,
    evaluator::{Crew, Evaluator},
};
use dispatch::journal::Recording;
use dispatch::scheduler::Completed;
use protocol::{event::Finished, id::JobId, job::Job};
use std::collections::VecDeque;

/// What is given every job with its result.
type Seen<'a> = &'a mut dyn FnMut(&Job, &Finished) -> Result<(), EvaluatorError>;

/// Results of a recording, in the order in which they are asked for.
pub struct Recorded<'a> {
    recording: &'a Recording,
    seen: Seen<'a>,
    asked: VecDeque<(JobId, Job)>,
    unknown: u64,
    ended: bool,
}

impl<'a> Recorded<'a> {
    /// Over a recording; `seen` is given every job with its result, before the study is.
    pub const fn new(recording: &'a Recording, seen: Seen<'a>) -> Self {
        Self {
            recording,
            seen,
            asked: VecDeque::new(),
            unknown: 0,
            ended: false,
        }
    }

    /// Jobs that were asked for and have no result in the recording.
    pub const fn unknown(&self) -> u64 {
        self.unknown
    }

    /// Whether a study asked for more than the recording holds, so that it went no further.
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
                "job {id} of the journal is not the one that the run's settings lead to"
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

impl Evaluator for Recorded<'_> {
    fn submit(&mut self, id: JobId, job: Job) -> Result<(), EvaluatorError> {
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
            message: "the journal holds no further results that this run asked for".to_owned(),
            help: Some("the command that began the run goes on with it".to_owned()),
        })
    }

    fn crew(&self) -> Crew {
        Crew::default()
    }
}
