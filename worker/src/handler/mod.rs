//! From a job to its outcome.
//!
//! A handler is a pure function of the case and the job. It knows nothing of slots or links.
mod score;
mod simulate;

use crate::convert;
use protocol::{
    case::Case,
    job::{Failure, Job, Outcome},
};
use simulation::model::Machine;

/// Everything that jobs on one case share, built once.
#[derive(Debug)]
pub struct Prepared {
    case: Case,
    /// One machine per condition.
    machines: Vec<Machine>,
}

impl Prepared {
    /// Builds the machines of a case.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the case cannot be built.
    pub fn new(case: &Case) -> Result<Self, Failure> {
        let machines = (0..case.conditions.len())
            .map(|condition| convert::machine(case, condition))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            case: case.clone(),
            machines,
        })
    }

    /// Does one job.
    pub fn evaluate(&self, job: &Job) -> Outcome {
        let outcome = match job {
            Job::Score(spec) => score::run(self, spec).map(Outcome::Scored),
            Job::Simulate(spec) => {
                simulate::run(self, spec).map(|done| Outcome::Simulated(Box::new(done)))
            }
            Job::Nothing { .. } => return nothing(job),
        };
        outcome.unwrap_or_else(Outcome::Failed)
    }

    fn machine(&self, condition: usize) -> Result<&Machine, Failure> {
        self.machines
            .get(condition)
            .ok_or_else(|| Failure::Misconfigured {
                field: "conditions".to_owned(),
                problem: format!("has no entry {condition}"),
            })
    }
}

/// Does a job that needs no case; `Refused` for any other.
pub fn nothing(job: &Job) -> Outcome {
    let Job::Nothing { reply_bytes, .. } = job else {
        return Outcome::Failed(Failure::Refused {
            reason: "this job needs a case".to_owned(),
        });
    };
    Outcome::Nothing(vec![0; *reply_bytes as usize])
}
