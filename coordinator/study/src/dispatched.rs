//! Evaluation of a study's jobs by the workers of a run.
use super::entry::Entry;
use super::error::{EvaluatorError, PROGRAM_REMEDY};
use super::evaluator::Evaluator;
use super::job_number::JobNumbers;
use dispatch::{
    runtime::{Dispatch, DispatchError},
    scheduler::{Completed, Snapshot, StopReason},
};
use journal::{JournalError, event::JobReason};
use protocol::{id::JobId, job::Job, wire};

impl Evaluator for Dispatch {
    fn submit(&mut self, id: JobId, job: Job, reason: JobReason) -> Result<(), EvaluatorError> {
        Ok(Self::submit(self, id, job, reason)?)
    }

    fn enter(&mut self, entry: &Entry) -> Result<(), EvaluatorError> {
        let entry = wire::encode(entry).map_err(|error| EvaluatorError {
            message: error.to_string(),
            help: None,
            can_go_on: false,
        })?;
        Ok(self.record(entry)?)
    }

    fn anticipate(&mut self, jobs: Vec<Job>) -> Result<(), EvaluatorError> {
        Ok(Self::anticipate(self, jobs)?)
    }

    fn computes_ahead(&self) -> bool {
        self.has_idle_slots()
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        Ok(Self::next(self).await?)
    }

    fn numbers(&self) -> Result<JobNumbers, EvaluatorError> {
        let mut numbers = JobNumbers::default();
        let read = journal::numbers(&self.journal(), |job, work| numbers.note(job, work));
        read.map_err(DispatchError::from)?;
        Ok(numbers)
    }

    fn snapshot(&self) -> Snapshot {
        Self::snapshot(self)
    }

    async fn current_snapshot(&self) -> Result<Snapshot, EvaluatorError> {
        Ok(Self::current_snapshot(self).await?)
    }
}

impl From<DispatchError> for EvaluatorError {
    fn from(error: DispatchError) -> Self {
        let of_program = matches!(
            &error,
            DispatchError::Stopped(StopReason::EverythingFails { last, .. }) if last.is_of_program()
        );
        let differs = matches!(
            &error,
            DispatchError::JobDiffers { .. }
                | DispatchError::Journal(JournalError::EntryDiffers { .. })
        );
        Self {
            message: error.to_string(),
            help: of_program.then(|| PROGRAM_REMEDY.to_owned()),
            can_go_on: !differs,
        }
    }
}
