//! Results that arrived before their jobs were submitted: a worker that outlived a coordinator process
//! delivers them as soon as the next process is running.
//!
//! They are held in memory only, up to a limit; workers send the remaining results again.
use protocol::{
    id::{JobId, WorkerId},
    message::Done,
    wire,
};
use std::collections::BTreeMap;

/// Largest number of results held for jobs not yet submitted.
const MOST: usize = 4096;
/// Largest total encoded size of the results held \[bytes\]: four times the largest result possible.
pub(super) const MOST_BYTES: usize = 64 << 20;

/// Results of jobs not (yet) submitted.
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
    /// Keeps a result that arrived before its job was submitted, if it is the first of that job and the
    /// limits on number and size allow it.
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

    /// Removes and returns the result of a newly submitted job, with the worker that delivered it.
    pub(super) fn take(&mut self, job: JobId) -> Option<(WorkerId, Done)> {
        let Held { from, done, bytes } = self.held.remove(&job)?;
        self.bytes -= bytes;
        Some((from, done))
    }

    /// Returns the total encoded size of the results held for jobs not yet submitted \[bytes\].
    #[cfg(test)]
    pub(super) const fn bytes(&self) -> usize {
        self.bytes
    }
}
