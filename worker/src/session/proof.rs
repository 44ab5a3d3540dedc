//! Proof that this worker computes the same results as the others, from the case's reference individual.
//!
//! The proof is an ordinary job in an ordinary slot: the recommended parameters under the condition of the
//! objective, with a derivative of each kind that the model gives. The coordinator compares the content hash
//! of the outcome, or some of its values where results do not repeat bit for bit. A case that cannot be built
//! gives a proof, too: its error message, which must be the same on every worker.
use crate::{
    pool::{CaseBytes, Task},
    simulator::{Simulators, simulator_of},
};
use protocol::{
    case::{Case, Reproducibility},
    id::{AttemptId, ContentHash, JobId},
    job::{Answer, Failure, Individual, Job, Observation, Outcome, Reply, SimulateSpec},
    message::Attempt,
    proof::{MAX_SAMPLES, ReferenceResult, Sample},
    wire,
};
use std::time::Duration;

/// Attempt id under which the reference individual runs; no coordinator gives it to a job.
pub(super) const ATTEMPT: Attempt = Attempt {
    job: JobId(u64::MAX),
    attempt: AttemptId(u32::MAX),
};

/// Time limit for computing the reference individual.
const DEADLINE: Duration = Duration::from_mins(10);

/// Progress of the proof that this worker computes correct results.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Progress {
    /// The proof has yet to be computed.
    Missing,
    /// A slot is computing the proof.
    Running,
    /// The proof has been computed and can be sent.
    Known(ReferenceResult),
}

impl Progress {
    /// Derives the proof from the outcome of the reference individual; returns an error if it shows that this
    /// worker cannot work.
    ///
    /// A model whose repeatability is unknown has nothing to compare; if its program fails at the reference
    /// individual, that is left to the coordinator and to the run's own jobs.
    pub(super) fn of(outcome: Option<Outcome>, repeats: Reproducibility) -> Result<Self, String> {
        let Some(outcome) = outcome else {
            return Ok(Self::Missing);
        };
        let proof = match (repeats, outcome) {
            (
                Reproducibility::Unknown,
                Outcome::Done(_)
                | Outcome::Failed(Failure::Crashed { .. } | Failure::Deadline { .. }),
            ) => ReferenceResult::Bits(ContentHash::of(b"not compared")),
            (
                Reproducibility::Within(_),
                Outcome::Failed(Failure::Crashed { .. } | Failure::Deadline { .. }),
            ) => ReferenceResult::Failed,
            (Reproducibility::Within(_), Outcome::Done(Answer::Channels(seen))) => {
                ReferenceResult::Values(samples(&seen))
            }
            (
                _,
                Outcome::Failed(
                    failure @ (Failure::Crashed { .. }
                    | Failure::Deadline { .. }
                    | Failure::Lost { .. }
                    | Failure::Refused { .. }),
                ),
            ) => {
                return Err(format!(
                    "the reference individual of the case cannot be computed here: {failure}"
                ));
            }
            (_, outcome) => match wire::encode(&outcome) {
                Ok(bytes) => ReferenceResult::Bits(ContentHash::of(&bytes)),
                Err(error) => {
                    return Err(format!(
                        "the result of the reference individual cannot be encoded: {error}"
                    ));
                }
            },
        };
        Ok(Self::Known(proof))
    }

    /// Returns the proof if it is known.
    pub(super) fn known(&self) -> Option<ReferenceResult> {
        match self {
            Self::Known(proof) => Some(proof.clone()),
            Self::Missing | Self::Running => None,
        }
    }
}

/// Selects sample values that represent the curves of a run: an equal number from each curve, evenly spaced.
fn samples(seen: &Observation) -> Vec<Sample> {
    let curves = seen.curves.iter().filter(|curve| !curve.is_empty());
    let share = (MAX_SAMPLES / curves.clone().count().max(1)).max(1);
    let of = |curve: &Vec<f64>| {
        let count = curve.len();
        let scale = (curve.iter().map(|x| x * x).sum::<f64>() / count as f64).sqrt();
        let taken = share.min(count);
        let value = move |at: usize| curve.get(at * count / taken).copied();
        let values: Vec<Sample> = (0..taken)
            .filter_map(value)
            .map(|value| Sample { value, scale })
            .collect();
        values
    };
    curves.flat_map(of).take(MAX_SAMPLES).collect()
}

/// Builds the task of computing a case's reference individual, and returns the repeatability of the case's
/// model.
///
/// # Errors
/// A message saying why the case cannot be simulated by this worker.
pub(super) fn task(
    simulators: Simulators,
    case: &CaseBytes,
) -> Result<(Task, Reproducibility), String> {
    let decoded: Case = wire::decode(&case.bytes)
        .map_err(|error| format!("case {} cannot be read here: {error}", case.hash))?;
    let condition = decoded.objective.condition;
    let compares_values = matches!(decoded.model.repeats, Reproducibility::Within(_));
    let reply = if decoded.is_measured(condition) && !compares_values {
        Reply::Score {
            with_residual: true,
            whole: false,
        }
    } else {
        Reply::Channels
    };
    let reference = Individual::new(condition, decoded.start());
    let mut spec = SimulateSpec::new(reference, reply);
    // a case of no known kind is refused by the job itself, in its own words
    if let (Reproducibility::Bits, Ok(simulator)) =
        (decoded.model.repeats, simulator_of(simulators, &decoded))
    {
        spec.columns = simulator.reference_columns(&decoded);
    }
    let job = Job::Simulate(spec);
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
    use protocol::job::{Counters, Verdict};

    fn crashed() -> Outcome {
        Outcome::Failed(Failure::crashed("ended by signal 6".to_owned()))
    }

    #[test]
    fn a_proof_names_every_bit_and_only_a_case_may_be_at_fault() {
        let of =
            |outcome| Progress::of(Some(outcome), Reproducibility::Bits).map(|proof| proof.known());
        let one = of(Outcome::Done(Answer::Nothing(vec![1]))).unwrap();
        assert!(one.is_some());
        assert_ne!(one, of(Outcome::Done(Answer::Nothing(vec![2]))).unwrap());
        let case_at_fault = Failure::misconfigured("beam", "no mass");
        assert!(of(Outcome::Failed(case_at_fault)).unwrap().is_some());
        let refused = of(crashed()).unwrap_err();
        assert!(refused.contains("cannot be computed here"), "{refused}");
        assert_eq!(
            Progress::of(None, Reproducibility::Bits),
            Ok(Progress::Missing),
            "cancelled: again"
        );
        let unknown = |outcome| Progress::of(Some(outcome), Reproducibility::Unknown);
        let answer = |byte| Outcome::Done(Answer::Nothing(vec![byte]));
        assert_eq!(unknown(answer(1)), unknown(answer(2)));
        assert_eq!(unknown(answer(1)), unknown(crashed()));
    }

    #[test]
    fn where_bits_do_not_repeat_values_stand_for_them() {
        let seen = Observation {
            verdict: Verdict::Complete,
            counters: Counters::default(),
            curves: vec![
                (0..1000).map(f64::from).collect(),
                Vec::new(),
                vec![3.0, 4.0],
            ],
            columns: Vec::new(),
        };
        let outcome = Outcome::Done(Answer::Channels(seen));
        let known = Progress::of(Some(outcome), Reproducibility::Within(1e-3));
        let Ok(Progress::Known(ReferenceResult::Values(samples))) = known else {
            panic!("{known:?}")
        };
        assert_eq!(
            samples.len(),
            34,
            "half of the room each, as far as they go"
        );
        assert_eq!(samples.iter().filter(|one| one.scale < 4.0).count(), 2);
        assert!((samples[31].value - 968.0).abs() < 1e-12);
        assert!((samples[33].scale - 12.5_f64.sqrt()).abs() < 1e-12);
        let failed = Progress::of(Some(crashed()), Reproducibility::Within(1e-3));
        assert_eq!(failed, Ok(Progress::Known(ReferenceResult::Failed)));
    }
}
