//! Results that came before their jobs were asked for: a worker that outlived a process of the
//! coordinator hands them in as soon as the next one is there.
//!
//! They are held in memory and nowhere else, so there is an end to them: workers repeat the others.
use protocol::{
    id::{JobId, WorkerId},
    message::Done,
    wire,
};
use std::collections::BTreeMap;

/// Most results.
const MOST: usize = 4096;
/// Most bytes of all of them, encoded: four of the longest that there can be.
pub(super) const MOST_BYTES: usize = 64 << 20;

/// Results of jobs that were not submitted (yet).
#[derive(Debug, Default)]
pub(super) struct UnclaimedResults {
    held: BTreeMap<JobId, Held>,
    bytes: usize,
}

#[derive(Debug)]
struct Held {
    from: WorkerId,
    done: Done,
    bytes: usize,
}

impl UnclaimedResults {
    /// Keeps the first result of a job, if there is room for it.
    pub(super) fn put(&mut self, from: WorkerId, done: Done) {
        let job = done.attempt.job;
        if self.held.len() >= MOST || self.held.contains_key(&job) {
            return;
        }
        // what cannot be encoded could not be stored either
        let Ok(bytes) = wire::encode(&done).map(|encoded| encoded.len()) else {
            return;
        };
        if self.bytes + bytes <= MOST_BYTES {
            self.bytes += bytes;
            self.held.insert(job, Held { from, done, bytes });
        }
    }

    /// The result of a job that is submitted now, and who brought it.
    pub(super) fn take(&mut self, job: JobId) -> Option<(WorkerId, Done)> {
        let Held { from, done, bytes } = self.held.remove(&job)?;
        self.bytes -= bytes;
        Some((from, done))
    }

    /// How many bytes are held.
    #[cfg(test)]
    pub(super) const fn bytes(&self) -> usize {
        self.bytes
    }
}
