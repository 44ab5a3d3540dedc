//! Interface of a stage: a part of a strategy that works batch by batch.
use super::{
    archive::{Archive, EvaluatedIndividual},
    family::DescentEnd,
    proposal::Purpose,
};

/// Batch-wise part of a strategy. It receives results only as whole batches, in the order in which it planned
/// them.
pub trait SearchStage {
    /// Returns the next batch to evaluate, never an empty one, or `None` when the stage has finished. The
    /// archive holds every result of the run so far.
    fn plan(&mut self, archive: &Archive) -> Option<Batch>;

    /// Takes the results of the batch planned last: one per draft, in the order of the drafts.
    fn absorb(&mut self, results: &[EvaluatedIndividual]);

    /// Returns points that the next batch will probably contain, likeliest first. `result` returns the result
    /// of a draft of the batch planned last, by the draft's index; `None` while it is awaited.
    fn anticipate(
        &self,
        _result: &dyn Fn(usize) -> Option<EvaluatedIndividual>,
    ) -> Vec<ProposalDraft> {
        Vec::new()
    }

    /// Returns the ends of the least-squares descents of a finished stage that converged.
    fn descent_ends(&self) -> Vec<DescentEnd> {
        Vec::new()
    }

    /// Returns the groups of individuals from which the next stage should begin (see [`Archive::start_groups`]);
    /// empty if a finished stage distinguishes none.
    fn start_groups(&self, _archive: &Archive) -> Vec<Vec<Vec<f64>>> {
        Vec::new()
    }

    /// Returns the number of generations that the stage adds to the search.
    fn generations(&self) -> u32;

    /// Returns the number of evaluations that the stage still expects, including the running batch.
    fn remaining(&self) -> u64;

    /// Returns whether a result reached the fitness threshold, which ends the whole search.
    fn reached_threshold(&self) -> bool {
        false
    }
}

/// Batch of points that can be evaluated at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Generation to which the batch belongs, counted from the start of the stage.
    pub generation: u32,
    /// Points of the batch, each with the purpose of its evaluation.
    pub drafts: Vec<ProposalDraft>,
}

/// Point that a stage wants to be evaluated, before it is assigned a proposal id.
#[derive(Clone, Debug, PartialEq)]
pub struct ProposalDraft {
    /// Gene values of the point in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Purpose for which the point is evaluated.
    pub purpose: Purpose,
}
