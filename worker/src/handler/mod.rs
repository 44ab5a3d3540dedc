//! From a job to its outcome: one file for each kind of job and each reply of a simulation.
//!
//! A pure function of the case and the job, which knows nothing of slots or links.
mod curves;
mod machines;
mod nothing;
mod ran;
mod reduce_head;
mod score;

pub use nothing::nothing;

use crate::convert;
use machines::Machines;
use protocol::{
    case::Case,
    job::{Answer, Failure, Job, Observation, Outcome, Reply, SimulateSpec},
};
use ran::Ran;
use simulation::observe::Recorder;

/// A case that jobs are done on.
#[derive(Debug)]
pub struct Prepared(Machines);

impl Prepared {
    /// Builds the machines of a case.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the case cannot be built.
    pub fn new(case: &Case) -> Result<Self, Failure> {
        Machines::new(case).map(Self)
    }

    /// Does one job.
    pub fn evaluate(&self, job: &Job) -> Outcome {
        match job {
            Job::Simulate(spec) => self.simulate(spec).into(),
            Job::ReduceHead(spec) => reduce_head::run(spec)
                .map(|head| Answer::HeadReduced(Box::new(head)))
                .into(),
            Job::Describe => Outcome::Done(Answer::Described(convert::effect::descriptors())),
            Job::Nothing { .. } => nothing(job),
        }
    }

    fn simulate(&self, spec: &SimulateSpec) -> Result<Answer, Failure> {
        let case = &self.0.unit.case;
        let condition = spec.individual.condition;
        Ok(match spec.reply {
            Reply::Score { with_residual } => {
                let ran = Ran::new(&self.0, spec, Recorder::gauges_only())?;
                let ended = (ran.verdict, ran.counters);
                let curves = ran.channels(case, condition)?;
                let evaluation = score::evaluation(case, condition, ended, &curves, with_residual)?;
                Answer::Scored(evaluation)
            }
            Reply::Channels => {
                let ran = Ran::new(&self.0, spec, Recorder::everything(0))?;
                let exact = Observation {
                    verdict: ran.verdict,
                    counters: ran.counters,
                    curves: ran.channels(case, condition)?,
                };
                Answer::Channels(exact.rounded(case, condition))
            }
            Reply::Curves { motion_step_deg } => {
                Answer::Curves(Box::new(curves::run(&self.0, spec, motion_step_deg)?))
            }
        })
    }
}
