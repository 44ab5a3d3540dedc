//! Jobs that do nothing, asked for so that nobody has to wait.
use crate::runtime::{dispatch::Dispatch, error::DispatchError};
use protocol::{id::JobId, job::Job};

/// Bytes of a job on its way to a worker, about those of a gene vector with its frame.
const JOB_BYTES: usize = 1000;
/// Jobs asked for ahead, per worker: enough to keep them busy.
const AHEAD: u64 = 4;
/// Jobs that are done between two looks at the clock, over those asked for ahead.
const ROUND: u64 = 16;

/// Jobs that do nothing, numbered in a row.
pub(super) struct Load {
    workers: u64,
    result_bytes: u32,
    /// How many were asked for.
    pub(super) next: u64,
    open: u64,
}

impl Load {
    /// For so many workers, with results of so many bytes.
    pub(super) fn new(workers: usize, result_bytes: u32) -> Self {
        Self {
            workers: workers.max(1) as u64,
            result_bytes,
            next: 0,
            open: 0,
        }
    }

    /// Jobs that keep everybody busy for a moment.
    pub(super) const fn round(&self) -> u64 {
        ROUND * self.ahead()
    }

    /// Jobs asked for ahead.
    const fn ahead(&self) -> u64 {
        AHEAD * self.workers
    }

    /// Has so many jobs done, some asked for ahead.
    pub(super) async fn run(
        &mut self,
        dispatch: &mut Dispatch,
        jobs: u64,
    ) -> Result<(), DispatchError> {
        let until = self.next + jobs;
        let ahead = self.ahead();
        while self.next < until || self.open > 0 {
            while self.next < until && self.open < ahead {
                self.submit(dispatch)?;
            }
            dispatch.next().await?;
            self.open -= 1;
        }
        Ok(())
    }

    fn submit(&mut self, dispatch: &mut Dispatch) -> Result<(), DispatchError> {
        let job = Job::Nothing {
            payload: vec![7; JOB_BYTES],
            reply_bytes: self.result_bytes,
            delay_ms: 0,
        };
        self.next += 1;
        self.open += 1;
        dispatch.submit(JobId(self.next - 1), job)
    }
}
