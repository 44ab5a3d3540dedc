//! Load of empty jobs for benchmarks, queued ahead so that workers do not wait.
use crate::runtime::{Dispatch, DispatchError};
use journal::event::JobReason;
use protocol::{id::JobId, job::Job};

/// Size of a job sent to a worker (bytes), about that of a gene vector with its frame.
const JOB_BYTES: usize = 1000;
/// Number of jobs to keep queued per worker, so that workers do not wait.
const AHEAD: u64 = 4;
/// Number of jobs between two clock readings of a benchmark, as a multiple of the number of queued jobs.
const ROUND: u64 = 16;

/// Source of consecutively numbered empty jobs for a benchmark.
pub struct Load {
    workers: u64,
    result_bytes: u32,
    /// Number of the next job; equals the number of jobs submitted so far.
    next: u64,
    open: u64,
}

impl Load {
    /// Returns the number of jobs submitted so far.
    pub const fn submitted(&self) -> u64 {
        self.next
    }

    /// Creates a job source for a number of workers; each job asks for a result of the given size (bytes).
    pub fn new(workers: usize, result_bytes: u32) -> Self {
        Self {
            workers: workers.max(1) as u64,
            result_bytes,
            next: 0,
            open: 0,
        }
    }

    /// Returns the number of jobs that keep all workers busy between two readings of the clock.
    pub const fn round(&self) -> u64 {
        ROUND * self.ahead()
    }

    /// Returns the number of jobs to keep queued.
    const fn ahead(&self) -> u64 {
        AHEAD * self.workers
    }

    /// Submits a number of jobs, keeping some queued ahead, and waits for all results.
    ///
    /// # Errors
    /// As [`Dispatch::submit`] and [`Dispatch::next`].
    pub async fn run(&mut self, dispatch: &mut Dispatch, jobs: u64) -> Result<(), DispatchError> {
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
        dispatch.submit(JobId(self.next - 1), job, JobReason::default())
    }
}
