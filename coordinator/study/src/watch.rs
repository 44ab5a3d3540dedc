//! Whoever watches a study: for people to see, it decides nothing.
use super::evaluator::Crew;

/// What a study of some kind shows of itself on the way.
pub trait View {
    /// Why the study wants a job done.
    type Reason: ?Sized;
}

/// Watches a study that shows itself as `V`.
pub trait Watch<V: View> {
    /// A result came back, or the study planned anew.
    fn progress(&mut self, view: &V, crew: &dyn Fn() -> Crew);

    /// Before anything else: how many results an earlier session left.
    fn resumed(&mut self, _recorded: usize) {}

    /// A job is going to be asked for.
    fn asked(&mut self, _id: u64, _reason: &V::Reason) {}
}
