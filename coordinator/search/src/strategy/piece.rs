//! A batch-wise part of a strategy.
use super::{
    archive::{Archive, Evaluated},
    proposal::Purpose,
};

/// One batch-wise part of a strategy. It sees results only as whole batches, in the order of its
/// own plan.
pub trait Piece {
    /// The next batch, or none when the piece is done; never an empty one. The archive holds
    /// every result of the run so far.
    fn plan(&mut self, archive: &Archive) -> Option<Batch>;

    /// Takes the results of the last batch: one per draft, in its order.
    fn absorb(&mut self, results: &[Evaluated]);

    /// How many generations it counts.
    fn generations(&self) -> u32;

    /// How many evaluations it still expects, the running batch included.
    fn remaining(&self) -> u64;

    /// Whether a result so good was found that the whole search ends.
    fn reached_threshold(&self) -> bool {
        false
    }
}

/// Points that can be evaluated at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Batch {
    /// Generation, counted from the start of the piece.
    pub generation: u32,
    /// The points, with what they are for.
    pub drafts: Vec<Draft>,
}

/// A point to evaluate.
#[derive(Clone, Debug, PartialEq)]
pub struct Draft {
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// What it is for.
    pub purpose: Purpose,
}
