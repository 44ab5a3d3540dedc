//! From a job to its outcome.
//!
//! A handler is a pure function of the case and the job. It knows nothing of slots or links.
use protocol::{
    case::Case,
    job::{Failure, Job, Outcome},
};

/// Everything that jobs on one case share, built once.
#[derive(Debug)]
pub struct Prepared {}

impl Prepared {
    /// Builds the model of a case.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the case cannot be built.
    pub const fn new(_case: &Case) -> Result<Self, Failure> {
        Ok(Self {})
    }

    /// Does one job.
    pub fn evaluate(&self, job: &Job) -> Outcome {
        match job {
            Job::Score(_) | Job::Simulate(_) => Outcome::Failed(Failure::Refused {
                reason: "this build has no dynamics".to_owned(),
            }),
            Job::Nothing { .. } => nothing(job),
        }
    }
}

/// Does a job that needs no case; `Refused` for any other.
pub fn nothing(job: &Job) -> Outcome {
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
        std::thread::sleep(std::time::Duration::from_millis(u64::from(*delay_ms)));
    }
    Outcome::Nothing(vec![0; *reply_bytes as usize])
}

/// Names the numerics of this build: equal digests promise equal bits.
pub fn model_digest() -> String {
    format!("nothing-{}", env!("CARGO_PKG_VERSION"))
}
