//! From a job to its outcome.
//!
//! A handler is a pure function of the case and the job. It knows nothing of slots or links.
mod observe;
mod reduce_head;
mod score;
mod simulate;

use crate::convert;
use protocol::{
    case::{Case, EffectSetting},
    id::ContentHash,
    job::{Failure, Job, Outcome},
};
use simulation::model::Machine;
use std::{borrow::Cow, sync::OnceLock};

/// Everything that jobs on one case share, built once.
#[derive(Debug)]
pub struct Prepared {
    case: Case,
    /// One machine per condition, with the case's effects as they are stated.
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
        convert::effect::check_genes(case)?;
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
            Job::Observe(spec) => observe::run(self, spec).map(Outcome::Observed),
            Job::ReduceHead(spec) => {
                reduce_head::run(spec).map(|done| Outcome::HeadReduced(Box::new(done)))
            }
            Job::Describe => return Outcome::Described(convert::effect::descriptors()),
            Job::Nothing { .. } => return nothing(job),
        };
        outcome.unwrap_or_else(Outcome::Failed)
    }

    /// The machine of a condition. Where genes are parameters of effects, every individual is a machine
    /// of its own; so is one that a job's own effects ask for.
    fn machine_with(
        &self,
        condition: usize,
        individual: (&[f64], &[EffectSetting]),
    ) -> Result<Cow<'_, Machine>, Failure> {
        let (_, effects) = individual;
        if !effects.is_empty() || self.case.has_effect_genes() {
            return convert::machine_with(&self.case, condition, individual).map(Cow::Owned);
        }
        let machine = self.machines.get(condition).map(Cow::Borrowed);
        machine.ok_or_else(|| convert::no_condition(condition))
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

/// Names the numerics of this build by the bits of two reference runs, without effects and with all of
/// them, and by the catalogue's units and bounds: equal digests promise equal results. Takes as long
/// as those runs, some tenths of a second, the first time in a process.
pub fn model_digest() -> &'static str {
    static DIGEST: OnceLock<String> = OnceLock::new();
    DIGEST.get_or_init(computed_digest)
}

fn computed_digest() -> String {
    let mut bytes = Vec::new();
    let plain = simulation::reference::bits();
    for (bits, statistics) in [plain, simulation::reference::bits_with_effects()] {
        bytes.extend(bits.iter().flat_map(|bits| bits.to_le_bytes()));
        bytes.extend_from_slice(format!("{statistics:?}").as_bytes());
    }
    bytes.extend_from_slice(format!("{:?}", convert::effect::descriptors()).as_bytes());
    ContentHash::of(&bytes).to_string()
}
