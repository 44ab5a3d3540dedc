//! The machine as a laboratory.
use super::Machine;
use discrepancy::laboratory::{Laboratory, Stage};
use protocol::job::{Observation, ObserveSpec};
use std::convert::Infallible;

/// A laboratory that simulates at once; some of its runs may be lost, and its effects may go by
/// other names.
pub(crate) struct AtOnce<'a> {
    machine: &'a Machine,
    /// One run in so many is lost, spread as a counter's hash spreads them; none if 0.
    lost_every: u64,
    /// Names that are used outside, with the machine's own.
    labels: &'a [(String, String)],
    runs: u64,
    /// Runs that were lost.
    pub(crate) lost: u64,
}

impl<'a> AtOnce<'a> {
    pub(crate) const fn new(
        machine: &'a Machine,
        lost_every: u64,
        labels: &'a [(String, String)],
    ) -> Self {
        Self {
            machine,
            lost_every,
            labels,
            runs: 0,
            lost: 0,
        }
    }

    fn one(&mut self, mut spec: ObserveSpec) -> Option<Observation> {
        self.runs += 1;
        let hash = self.runs.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        if self.lost_every > 0 && hash.is_multiple_of(self.lost_every) {
            self.lost += 1;
            return None;
        }
        for effect in &mut spec.effects {
            if let Some((_, own)) = self.labels.iter().find(|(label, _)| *label == effect.id) {
                effect.id.clone_from(own);
            }
        }
        Some(self.machine.observe(&spec))
    }
}

impl Laboratory for AtOnce<'_> {
    type Error = Infallible;

    async fn observe(
        &mut self,
        _: Stage,
        batch: Vec<ObserveSpec>,
    ) -> Result<Vec<Option<Observation>>, Infallible> {
        Ok(batch.into_iter().map(|spec| self.one(spec)).collect())
    }
}
