//! Proof that this worker computes what the others compute: the case's reference individual.
//!
//! It is an ordinary job in an ordinary slot: the recommended parameters under the condition of
//! the objective. The name of its outcome's bits is what the coordinator compares. A case that
//! cannot be built gives a proof too: that of what is wrong with it, which must be the same
//! everywhere.
use crate::pool::{CaseBytes, Task};
use protocol::{
    case::Case,
    id::{AttemptId, ContentHash, JobId},
    job::{Failure, Individual, Job, Outcome, Reply, SimulateSpec},
    message::Attempt,
    wire,
};
use std::time::Duration;

/// What the reference individual is called; no coordinator gives this name to a job.
pub(super) const ATTEMPT: Attempt = Attempt {
    job: JobId(u64::MAX),
    attempt: AttemptId(u32::MAX),
};

/// From start to forced end.
const DEADLINE: Duration = Duration::from_mins(10);

/// How far the proof has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Proof {
    /// It is still to be computed.
    Missing,
    /// A slot computes it.
    Running,
    /// The name of its bits.
    Known(ContentHash),
}

impl Proof {
    /// What came out; why this worker cannot work if nothing did.
    ///
    /// Where a model does not repeat its bits there is nothing to compare; that its program fails at the reference
    /// individual is for the run's own jobs to say.
    pub(super) fn of(outcome: Option<Outcome>, repeats: bool) -> Result<Self, String> {
        match outcome {
            None => Ok(Self::Missing),
            Some(
                Outcome::Done(_)
                | Outcome::Failed(Failure::Crashed { .. } | Failure::Deadline { .. }),
            ) if !repeats => Ok(Self::Known(ContentHash::of(b"not compared"))),
            Some(Outcome::Failed(
                failure @ (Failure::Crashed { .. }
                | Failure::Deadline { .. }
                | Failure::Lost { .. }
                | Failure::Refused { .. }),
            )) => Err(format!(
                "the reference individual of the case cannot be computed here: {failure}"
            )),
            Some(outcome) => match wire::encode(&outcome) {
                Ok(bytes) => Ok(Self::Known(ContentHash::of(&bytes))),
                Err(error) => Err(format!("the reference individual has no name: {error}")),
            },
        }
    }

    /// The name of its bits, if it is known.
    pub(super) const fn known(&self) -> Option<ContentHash> {
        match self {
            Self::Known(proof) => Some(*proof),
            Self::Missing | Self::Running => None,
        }
    }
}

/// The reference individual of a case, as a task, and whether its bits are the same everywhere; why there is none
/// if there is none.
pub(super) fn task(case: &CaseBytes) -> Result<(Task, bool), String> {
    let decoded: Case = wire::decode(&case.bytes)
        .map_err(|error| format!("case {} cannot be read here: {error}", case.hash))?;
    let condition = decoded.objective.condition;
    let reply = if decoded.is_measured(condition) {
        Reply::Score {
            with_residual: true,
        }
    } else {
        Reply::Channels
    };
    let reference = Individual::new(condition, decoded.start());
    let job = Job::Simulate(SimulateSpec::new(reference, reply));
    let own = decoded.model.deadline_s.map(Duration::try_from_secs_f64);
    let deadline = own
        .and_then(Result::ok)
        .map_or(DEADLINE, |own| own + DEADLINE);
    let task = Task {
        attempt: ATTEMPT,
        deadline,
        job: Box::new(job),
        case: Some(case.clone()),
    };
    Ok((task, decoded.model.repeats))
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::job::Answer;

    #[test]
    fn a_proof_names_every_bit_and_only_a_case_may_be_at_fault() {
        let of = |outcome| Proof::of(Some(outcome), true).map(|proof| proof.known());
        let one = of(Outcome::Done(Answer::Nothing(vec![1]))).unwrap();
        assert!(one.is_some());
        assert_ne!(one, of(Outcome::Done(Answer::Nothing(vec![2]))).unwrap());
        let case_at_fault = Failure::misconfigured("beam", "no mass");
        assert!(of(Outcome::Failed(case_at_fault)).unwrap().is_some());
        let how = "ended by signal 6".to_owned();
        let refused = of(Outcome::Failed(Failure::Crashed { how })).unwrap_err();
        assert!(refused.contains("cannot be computed here"), "{refused}");
        assert_eq!(
            Proof::of(None, true),
            Ok(Proof::Missing),
            "cancelled: again"
        );
        let inexact = |byte| Proof::of(Some(Outcome::Done(Answer::Nothing(vec![byte]))), false);
        assert_eq!(inexact(1), inexact(2));
    }
}
