//! Observer of a study, for display only: no influence on results.
use super::evaluator::WorkersSnapshot;

/// Type of progress that one kind of study reports to its observer.
pub trait View {
    /// Reason for which the study requests a job.
    type Reason: ?Sized;
}

/// Observer of a study that reports its progress as `V`.
pub trait Watch<V: View> {
    /// Receives the progress when a result has arrived or the study has changed its plan; `crew` returns the
    /// worker status.
    fn progress(&mut self, view: &V, crew: &dyn Fn() -> WorkersSnapshot);

    /// Receives the number of results from an earlier session, before any other call.
    fn resumed(&mut self, _recorded: usize) {}

    /// Receives the number of a job and the reason for it, before the job is submitted.
    fn asked(&mut self, _id: u64, _reason: &V::Reason) {}
}
