//! A diagnosis on the workers: a laboratory whose experiments are jobs.
//!
//! Experiments are numbered in the order in which the diagnosis asks for them, and that order depends
//! on results alone: a run that is opened again finds every one of them in its journal.
use super::{Crew, Evaluator, Stop, StudyError, calibrate::or_stop};
use discrepancy::diagnose::{Diagnosis, Inputs, diagnose};
use discrepancy::laboratory::{Laboratory, Stage};
use protocol::{
    announce::EffectDescriptor,
    job::{Job, Observation, ObserveSpec, Outcome, Verdict},
};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What one stage has cost so far.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Account {
    /// Experiments that came back.
    pub experiments: u64,
    /// Of those, how many did not run to their end.
    pub failed: u64,
    /// Batches in which they were asked for: what is in one is independent, one follows another.
    pub batches: u64,
    /// Time from the first experiment's start to the last one's end, waiting included.
    pub wall: Duration,
}

/// Watches a diagnosis.
pub trait Watch {
    /// An experiment of a stage came back; `open` more of its batch are awaited.
    fn progress(&mut self, stage: Stage, done: u64, open: usize, crew: &dyn Fn() -> Crew);

    /// An experiment of a stage is going to be done, as the job of this id.
    fn asked(&mut self, _stage: Stage, _id: u64) {}
}

/// A finished diagnosis, and what it cost.
#[derive(Clone, Debug)]
pub struct Diagnosed {
    /// The answer.
    pub diagnosis: Diagnosis,
    /// Stages that did experiments.
    pub accounts: Vec<(Stage, Account)>,
}

/// The id of the question for the effects that the workers know.
const LIBRARY: u64 = 0;

/// Asks a worker for the effects that it can simulate.
///
/// # Errors
/// If nobody answers, or the user stops.
pub async fn library<E: Evaluator>(
    evaluator: &mut E,
    stop: &mut Stop,
) -> Result<Vec<EffectDescriptor>, StudyError> {
    evaluator.submit(LIBRARY, Job::Describe)?;
    let completed = or_stop(evaluator.next(), stop).await??;
    match completed.outcome {
        Outcome::Described(effects) => Ok(effects),
        Outcome::Failed(failure) => Err(StudyError::hopeless(&failure).unwrap_or(
            StudyError::Unavailable {
                what: "the list of effects".to_owned(),
                failure,
            },
        )),
        Outcome::Scored(_)
        | Outcome::Simulated(_)
        | Outcome::Observed(_)
        | Outcome::HeadReduced(_)
        | Outcome::Nothing(_) => Err(StudyError::WrongKind { id: completed.id }),
    }
}

/// Diagnoses on an evaluator.
///
/// # Errors
/// If the workers cannot build the case or an effect, nobody evaluates any more, or the user stops.
pub async fn diagnose_on<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    watch: &mut dyn Watch,
    stop: &mut Stop,
) -> Result<Diagnosed, StudyError> {
    let mut jobs = Jobs {
        evaluator,
        watch,
        stop,
        next_id: LIBRARY + 1,
        accounts: BTreeMap::new(),
    };
    let diagnosis = diagnose(&mut jobs, inputs).await?;
    Ok(Diagnosed {
        diagnosis,
        accounts: jobs.accounts.into_iter().collect(),
    })
}

/// Experiments as jobs.
struct Jobs<'a, E> {
    evaluator: &'a mut E,
    watch: &'a mut dyn Watch,
    stop: &'a mut Stop,
    next_id: u64,
    accounts: BTreeMap<Stage, Account>,
}

impl<E: Evaluator> Laboratory for Jobs<'_, E> {
    type Error = StudyError;

    async fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<ObserveSpec>,
    ) -> Result<Vec<Option<Observation>>, StudyError> {
        let started = Instant::now();
        let first = self.next_id;
        let mut results: Vec<Option<Observation>> = vec![None; batch.len()];
        let mut open = batch.len();
        for spec in batch {
            self.watch.asked(stage, self.next_id);
            self.evaluator.submit(self.next_id, Job::Observe(spec))?;
            self.next_id += 1;
        }
        while open > 0 {
            let completed = or_stop(self.evaluator.next(), self.stop).await??;
            let place = completed
                .id
                .checked_sub(first)
                .and_then(|k| usize::try_from(k).ok());
            let Some(slot) = place.and_then(|k| results.get_mut(k)) else {
                continue;
            };
            let account = self.accounts.entry(stage).or_default();
            account.experiments += 1;
            match completed.outcome {
                Outcome::Observed(seen) => {
                    account.failed += u64::from(seen.verdict != Verdict::Complete);
                    *slot = Some(seen);
                }
                // a failure that every experiment would meet ends the diagnosis
                Outcome::Failed(failure) => match StudyError::hopeless(&failure) {
                    Some(error) => return Err(error),
                    None => account.failed += 1,
                },
                Outcome::Scored(_)
                | Outcome::Simulated(_)
                | Outcome::Described(_)
                | Outcome::HeadReduced(_)
                | Outcome::Nothing(_) => {
                    return Err(StudyError::WrongKind { id: completed.id });
                }
            }
            open -= 1;
            let evaluator = &*self.evaluator;
            self.watch
                .progress(stage, account.experiments, open, &|| evaluator.crew());
        }
        let account = self.accounts.entry(stage).or_default();
        account.batches += u64::from(!results.is_empty());
        account.wall += started.elapsed();
        Ok(results)
    }
}
