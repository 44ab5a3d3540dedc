//! A model in one function, as a laboratory that answers at once.
use discrepancy::laboratory::{Laboratory, Stage};
use discrepancy::record::Curves;
use protocol::job::{Counters, Observation, SimulateSpec, Verdict};
use std::convert::Infallible;

/// The curves of a job; nothing where it does not run.
pub(crate) struct ByCurves(pub(crate) fn(&SimulateSpec) -> Option<Curves>);

impl Laboratory for ByCurves {
    type Error = Infallible;

    async fn observe(
        &mut self,
        _: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, Infallible> {
        let seen = |spec: &SimulateSpec| {
            Some(Observation {
                verdict: Verdict::Complete,
                counters: Counters::default(),
                curves: (self.0)(spec)?,
                columns: Vec::new(),
            })
        };
        Ok(batch.iter().map(seen).collect())
    }
}
