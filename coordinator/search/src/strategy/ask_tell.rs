//! Interface of every search strategy: ask for proposals, tell their results.
use super::{
    archive::{Archive, Residual},
    evaluation_result::EvaluationResult,
    family::DescentEnd,
    outcome::{Best, Finish, Progress},
    proposal::Proposal,
    stage::ProposalDraft,
};

/// Search for the individual of smallest fitness, in ask/tell form.
pub trait Strategy {
    /// Returns all proposals that can be evaluated now and have not been handed out before; ids are
    /// consecutive from 0 over the whole run. Empty while results are awaited, and at the end.
    fn ask(&mut self) -> Vec<Proposal>;

    /// Takes the result of a proposal. Results may come in any order: they are buffered and consumed in id
    /// order, so the search does not depend on the order of arrival. A second result for the same id is
    /// ignored.
    fn tell(&mut self, id: u64, result: EvaluationResult);

    /// Takes the residual vector of a proposal whose purpose requires one, before its result. A strategy that
    /// needs no residuals ignores it.
    fn tell_residual(&mut self, _id: u64, _residual: Residual) {}

    /// Returns individuals that the search will probably propose next, likeliest first, judged by all results
    /// told so far; slots that would be idle can evaluate them before they are proposed. The search does not
    /// depend on whether that happens.
    fn anticipate(&self) -> Vec<ProposalDraft> {
        Vec::new()
    }

    /// Returns why the search is over; `None` while it is running.
    fn finished(&self) -> Option<Finish>;

    /// Returns the progress of the search: generations, evaluations and best fitness so far.
    fn progress(&self) -> Progress;

    /// Returns the best individual so far: complete before failed, then by fitness, then by id.
    fn best(&self) -> Option<Best>;

    /// Returns the ends of the least-squares descents that converged; empty for a strategy without descents.
    fn descent_ends(&self) -> &[DescentEnd] {
        &[]
    }

    /// Returns the archive of all results that the search has consumed, in id order.
    fn archive(&self) -> &Archive;
}
