//! Evaluates a job of any kind of model to its outcome: a score or a specific reply.
//!
//! The outcome is a pure function of case and job; this module does not know slots or links.
mod conditions;
mod no_op;
mod score;

pub use no_op::no_op;

use crate::simulator::{Model, Simulator, Simulators, simulator_of};
use protocol::{
    case::Case,
    job::{Answer, Failure, Job, Outcome, Reply, SimulateSpec},
};

/// Case with its model built, ready to evaluate jobs.
#[derive(Debug)]
pub struct Prepared {
    case: Case,
    simulator: &'static dyn Simulator,
    model: Box<dyn Model>,
}

impl Prepared {
    /// Builds the model of a case.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] if the case cannot be built, or if its kind of model is not in
    /// `simulators`.
    pub fn new(simulators: Simulators, case: &Case) -> Result<Self, Failure> {
        let simulator = simulator_of(simulators, case)?;
        Ok(Self {
            model: simulator.prepare(case)?,
            case: case.clone(),
            simulator,
        })
    }

    /// Evaluates one job of the case to its outcome.
    pub fn evaluate(&self, job: &Job) -> Outcome {
        match job {
            Job::Simulate(spec) => self.simulate(spec).into(),
            Job::Own { name, body } => self
                .simulator
                .run_custom(name, body)
                .map(Answer::Own)
                .into(),
            Job::Describe => Outcome::Done(Answer::Described(self.simulator.effects())),
            Job::Nothing { .. } => no_op(job),
        }
    }

    fn simulate(&self, spec: &SimulateSpec) -> Result<Answer, Failure> {
        let (case, condition) = (&self.case, spec.individual.condition);
        Ok(match spec.reply {
            Reply::Score {
                with_residual,
                whole,
            } => {
                let score = |spec: &SimulateSpec| {
                    let seen = self.model.observe(spec, true)?;
                    score::evaluation((case, spec.individual.condition), &seen, with_residual)
                };
                Answer::Scored(if whole && case.objective.condition == condition {
                    conditions::scored(&case.objective, spec, score)?
                } else {
                    score(spec)?
                })
            }
            Reply::Channels => {
                let seen = self.model.observe(spec, false)?;
                Answer::Channels(seen.rounded(case, condition))
            }
            Reply::Curves { pictures } => {
                Answer::Curves(Box::new(self.model.all_curves(spec, pictures)?))
            }
        })
    }
}
