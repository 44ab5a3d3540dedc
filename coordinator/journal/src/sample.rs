//! Sample events for tests of code that reads or writes journals.
use crate::event::{Event, Finished};
use protocol::{
    id::{AttemptId, ContentHash, JobId},
    job::{Answer, Outcome},
    message::{Attempt, Cost},
};

/// Returns the event of a job's result; the content hash is that of the job's number.
pub(crate) fn finished(job: u64, wall_us: u64, outcome: Outcome) -> Event {
    Event::Finished(Box::new(Finished {
        attempt: Attempt {
            job: JobId(job),
            attempt: AttemptId(7),
        },
        work: ContentHash::of(&job.to_le_bytes()),
        worker: None,
        cost: Cost {
            wall_us,
            cpu_us: wall_us / 2,
        },
        outcome,
    }))
}

/// Returns the journal event of a sample result, which differs between jobs.
pub(crate) fn result(job: u64) -> Event {
    finished(
        job,
        11 * job,
        Outcome::Done(Answer::Nothing(job.to_le_bytes().repeat(3))),
    )
}
