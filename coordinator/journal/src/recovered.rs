//! State of a run as it follows from the events of its journal, of which a new coordinator process goes on.
use super::read::{JournalEntry, ReadReport};
use crate::event::{Event, RunHeader};
use protocol::{
    id::{JobId, RunId, WorkerId},
    proof::ReferenceResult,
};
use std::collections::{BTreeMap, BTreeSet};

/// Minimum length of the record that a coordinator process writes when it opens the journal (bytes); bounds
/// how many such records a damaged stretch may have held.
const MIN_OPENED_BYTES: u64 = 20;

/// Maximum number of epochs (numbers of coordinator processes) skipped because their opening records may be
/// lost in damaged stretches.
const MOST_HIDDEN: u64 = 1000;

/// Number of later coordinator processes of the run after which an absent worker is no longer expected back.
const MAX_ABSENT_EPOCHS: u32 = 8;

/// State of a run, accumulated from the events of its journal.
#[derive(Debug, Default)]
pub struct RecoveredRun {
    pub(super) begun: Option<(RunId, RunHeader)>,
    epoch: u32,
    /// Digest of the model (numerics) on the run's first worker.
    pub model_digest: Option<String>,
    /// Result of the case's reference individual on the run's first worker.
    pub proof: Option<ReferenceResult>,
    /// Workers that joined the run and did not leave, with the coordinator process (epoch) that they joined.
    pub present: BTreeMap<WorkerId, u32>,
    /// Jobs with the offsets of their results in the journal (bytes), in its order.
    pub results: Vec<(JobId, u64)>,
    /// Jobs whose requests the journal holds.
    pub asked: BTreeSet<JobId>,
    /// Encoded entries of the study by number; of several with the same number the first counts.
    pub found: BTreeMap<u64, Vec<u8>>,
}

impl RecoveredRun {
    /// Adds the next event of the journal.
    pub fn apply(&mut self, entry: JournalEntry, event: Event) {
        match event {
            Event::Begun { run, header } => self.begun = self.begun.take().or(Some((run, header))),
            Event::Opened { epoch, .. } => {
                self.epoch = self.epoch.max(epoch);
                self.present
                    .retain(|_, joined| *joined + MAX_ABSENT_EPOCHS >= epoch);
            }
            Event::Joined {
                worker,
                model_digest,
                ..
            } => {
                self.model_digest.get_or_insert(model_digest);
                self.present.insert(worker, self.epoch);
            }
            Event::Left { worker, .. } => drop(self.present.remove(&worker)),
            // all were told to forget the run
            Event::Closed => self.present.clear(),
            Event::Proved { proof } => {
                self.proof.get_or_insert(proof);
            }
            Event::Finished(finished) => self.results.push((finished.job(), entry.at)),
            Event::Asked(asked) => drop(self.asked.insert(asked.job)),
            Event::Accounted(_) => {}
            Event::Found { number, entry } => {
                self.found.entry(number).or_insert_with(|| entry.into_vec());
            }
        }
    }

    /// Returns a number for this coordinator process (epoch) that no earlier process of the run has used:
    /// identifiers of attempts contain it, and workers of a lost process may still hold attempts.
    pub fn next_epoch(&self, report: &ReadReport) -> u32 {
        let damaged = damaged_bytes(report)
            .div_ceil(MIN_OPENED_BYTES)
            .min(MOST_HIDDEN);
        self.epoch + 1 + u32::try_from(damaged).unwrap_or(0)
    }
}

/// Returns the number of bytes of a journal that cannot be read.
pub(super) fn damaged_bytes(report: &ReadReport) -> u64 {
    report.damage.iter().map(|damage| damage.bytes).sum()
}
