//! Observer of a study, for display only: no influence on results.
use dispatch::scheduler::Snapshot;

/// Observer of a study that reports its progress as `V`.
pub trait Watch<V> {
    /// Receives the study's progress whenever a result has arrived or the plan has changed; `snapshot` returns
    /// the status of the workers.
    fn progress(&mut self, view: &V, snapshot: &dyn Fn() -> Snapshot);

    /// Receives the number of results from an earlier session, before any other call.
    fn resumed(&mut self, _recorded: usize) {}

    /// Receives notes about the case and its records.
    fn noted(&mut self, _notes: &[String]) {}
}
