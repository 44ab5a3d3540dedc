//! Job that does nothing, used to measure the message bus; it needs no case.
use protocol::job::{Answer, Failure, Job, Outcome};
use std::{thread, time::Duration};

/// Evaluates a job that needs no case; returns `Refused` for any other job.
pub fn no_op(job: &Job) -> Outcome {
    let Job::Nothing {
        reply_bytes,
        delay_ms,
        ..
    } = job
    else {
        return Outcome::Failed(Failure::Refused {
            reason: format!("a {} job needs a case", job.kind()),
        });
    };
    if *delay_ms > 0 {
        thread::sleep(Duration::from_millis(u64::from(*delay_ms)));
    }
    Outcome::Done(Answer::Nothing(vec![0; *reply_bytes as usize]))
}
