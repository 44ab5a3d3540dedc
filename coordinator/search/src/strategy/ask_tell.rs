//! The contract of every search.
use super::{
    archive::{Archive, Residual},
    outcome::{Best, Finish, Progress},
    proposal::Proposal,
    told::Told,
};

/// A search for the individual of smallest fitness.
pub trait Strategy {
    /// Everything that can be evaluated now and has not been handed out before; ids are
    /// consecutive from 0 over the whole run. Empty while results are awaited, and at the end.
    fn ask(&mut self) -> Vec<Proposal>;

    /// Takes the result of a proposal. Results may come in any order: they are buffered and
    /// consumed in id order, so nothing ever depends on arrival. A result told twice is ignored.
    fn tell(&mut self, id: u64, result: Told);

    /// Takes the residual vector of a proposal whose purpose wants one, before its result.
    /// A strategy that wants none ignores it.
    fn tell_residual(&mut self, _id: u64, _residual: Residual) {}

    /// Why the search is over, if it is.
    fn finished(&self) -> Option<Finish>;

    /// How far it has come.
    fn progress(&self) -> Progress;

    /// The best individual so far: complete before failed, then by fitness, then by id.
    fn best(&self) -> Option<Best>;

    /// Every result that was consumed, in id order.
    fn archive(&self) -> &Archive;
}
