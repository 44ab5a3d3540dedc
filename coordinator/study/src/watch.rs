//! Observer of a study, for display only: no influence on results.
use super::evaluator::Crew;

/// Progress that a kind of study reports to its observer.
pub trait View {
    /// Reason for which the study requests a job.
    type Reason: ?Sized;
}

/// Observer of a study that reports its progress as `V`.
pub trait Watch<V: View> {
    /// Called when a result has arrived or the study has changed its plan.
    fn progress(&mut self, view: &V, crew: &dyn Fn() -> Crew);

    /// Called first, with the number of results of an earlier session.
    fn resumed(&mut self, _recorded: usize) {}

    /// Called before a job is requested.
    fn asked(&mut self, _id: u64, _reason: &V::Reason) {}
}
