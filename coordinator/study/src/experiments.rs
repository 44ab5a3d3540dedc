//! Executor of the experiments (simulations) of a diagnosis or identification as jobs of an evaluator.
//!
//! Experiments are numbered in the order in which they are requested, which depends on results alone; a
//! resumed run therefore finds all of them in its journal.
use super::{
    batch::run_batch,
    entry::{Entry, StageCost},
    error::{EvaluatorError, StudyError},
    evaluator::{Evaluator, answer},
    known::{Key, KnownObservations, key, part, places},
    stop::Stop,
    watch::Watch,
};
use discrepancy::budget::cost as price;
use discrepancy::diagnose::Inputs;
use discrepancy::laboratory::{Finding, Laboratory, Stage};
use journal::event::JobReason;
use journal::job_range::LIBRARY;
use protocol::{
    announce::EffectDescriptor,
    id::JobId,
    job::{Answer, Column, Job, Observation, SimulateSpec, Verdict},
};
use std::collections::BTreeMap;

/// Progress of the current stage of a diagnosis or identification.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StageView {
    /// All stages through which the diagnosis or identification may pass, in order.
    pub stages: &'static [Stage],
    /// Stage that is currently running.
    pub stage: Stage,
    /// Number of completed experiments (simulations) of the current stage.
    pub done: u64,
    /// Number of experiments of the current batch without a result.
    pub open: usize,
    /// Cost of all stages so far, in units of one plain simulation.
    pub spent: f64,
    /// Remaining budget of the stage, in units of one plain simulation.
    pub left: f64,
}

/// Asks a worker for the effects that it can simulate.
///
/// # Errors
/// If no worker answers, or the user stops.
pub async fn library<E: Evaluator>(
    evaluator: &mut E,
    stop: &mut Stop,
) -> Result<Vec<EffectDescriptor>, StudyError> {
    let jobs = vec![(JobId(LIBRARY), Job::Describe)];
    let reason = JobReason::outside_search("library");
    let mut effects = Vec::new();
    run_batch(evaluator, jobs, &reason, stop, |_, _, completed| {
        let what = || "the list of effects".to_owned();
        effects = answer(completed, Answer::into_described, what)?;
        Ok(())
    })
    .await?;
    Ok(effects)
}

/// Enters the stages of a study with their budgets, in simulations without derivatives.
pub(super) fn enter_budget<E: Evaluator>(
    evaluator: &mut E,
    inputs: &Inputs,
    stages: &[Stage],
) -> Result<(), StudyError> {
    let budget = inputs.budget();
    let of = |stage: &Stage| (*stage, budget[*stage as usize]);
    Ok(evaluator.enter(&Entry::Budgeted(stages.iter().map(of).collect()))?)
}

/// Runner of a study's experiments (simulations), which it submits to an evaluator as jobs.
pub(super) struct Jobs<'a, E> {
    evaluator: &'a mut E,
    watch: &'a mut dyn Watch<StageView>,
    stop: &'a mut Stop,
    next_id: u64,
    differentiates: bool,
    stages: &'static [Stage],
    costs: BTreeMap<Stage, StageCost>,
    known: KnownObservations,
    /// Cost of the completed experiments, in units of one plain simulation.
    spent: f64,
    /// Remaining budget of each stage, in units of one plain simulation.
    left: [f64; Stage::ALL.len()],
}

impl<'a, E: Evaluator> Jobs<'a, E> {
    /// Creates the executor of a study's experiments; their jobs are numbered from `first`.
    pub(super) fn new(
        (evaluator, first): (&'a mut E, u64),
        inputs: &Inputs,
        stages: &'static [Stage],
        watch: &'a mut dyn Watch<StageView>,
        stop: &'a mut Stop,
    ) -> Self {
        Self {
            evaluator,
            watch,
            stop,
            next_id: first,
            differentiates: !inputs.differences,
            stages,
            costs: BTreeMap::new(),
            known: KnownObservations::default(),
            spent: 0.0,
            left: inputs.budget(),
        }
    }

    /// Returns the cost of each stage that ran experiments.
    pub(super) fn accounts(self) -> Vec<(Stage, StageCost)> {
        self.costs.into_iter().collect()
    }
}

impl<E: Evaluator> Laboratory for Jobs<'_, E> {
    type Error = StudyError;

    fn differentiates(&self) -> bool {
        self.differentiates
    }

    fn is_known(&self, spec: &SimulateSpec) -> bool {
        let key = key(spec).ok();
        key.is_some_and(|key| self.known.answer(&key, &spec.columns).is_some())
    }

    fn found(&mut self, finding: &Finding) -> Result<(), StudyError> {
        Ok(self.evaluator.enter(&Entry::Interim(finding.clone()))?)
    }

    async fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, StudyError> {
        let Planned {
            mut results,
            asked,
            shared,
            jobs,
        } = self.plan(stage, batch)?;
        let mut open = jobs.len();
        let reason = JobReason::outside_search(stage.name());
        let Self {
            evaluator,
            watch,
            stop,
            stages,
            costs,
            spent,
            left,
            ..
        } = self;
        run_batch(
            *evaluator,
            jobs,
            &reason,
            stop,
            |evaluator, index, completed| {
                let Some(own) = asked.get(index) else {
                    return Ok(());
                };
                let price = price(own.columns.len());
                *spent += price;
                left[stage as usize] -= price;
                let cost = costs.entry(stage).or_default();
                cost.experiments += 1;
                cost.with_derivatives += u64::from(!own.columns.is_empty());
                let id = completed.id;
                match completed.outcome.done() {
                    Ok(answer) => {
                        let seen = answer.into_channels();
                        let seen = seen.map_err(|_| StudyError::WrongKind { id })?;
                        cost.failed += u64::from(seen.verdict != Verdict::Complete);
                        results[own.place] = Some(seen);
                    }
                    // a failure that every experiment would meet ends the diagnosis
                    Err(failure) => match StudyError::from_systematic_failure(&failure) {
                        Some(error) => return Err(error),
                        None => cost.failed += 1,
                    },
                }
                open -= 1;
                let view = StageView {
                    stages,
                    stage,
                    done: cost.experiments,
                    open,
                    spent: *spent,
                    left: left[stage as usize].max(0.0),
                };
                watch.progress(&view, &|| evaluator.snapshot());
                Ok(())
            },
        )
        .await?;
        let cost = self.costs.entry(stage).or_default();
        cost.batches += u64::from(!asked.is_empty());
        for (place, index, columns) in shared {
            let seen = asked.get(index).and_then(|own| results[own.place].as_ref());
            results[place] = seen.and_then(|seen| part(seen, &columns));
        }
        for Asked {
            place,
            key,
            columns,
        } in asked
        {
            if let Some(seen) = &results[place] {
                self.known.insert(key, columns, seen.clone());
            }
        }
        Ok(results)
    }
}

impl<E> Jobs<'_, E> {
    /// Answers what is known of a batch, and numbers the jobs of the rest.
    fn plan(&mut self, stage: Stage, batch: Vec<SimulateSpec>) -> Result<Planned, StudyError> {
        let mut planned = Planned {
            results: vec![None; batch.len()],
            asked: Vec::new(),
            shared: Vec::new(),
            jobs: Vec::new(),
        };
        let cost = self.costs.entry(stage).or_default();
        for (place, spec) in batch.into_iter().enumerate() {
            let key = key(&spec).map_err(|error| EvaluatorError {
                message: error.to_string(),
                help: None,
                can_go_on: false,
            })?;
            if let Some(answer) = self.known.answer(&key, &spec.columns) {
                planned.results[place] = Some(answer);
                cost.known += 1;
                continue;
            }
            let same = planned.asked.iter().enumerate().find_map(|(index, own)| {
                let columns = places(&spec.columns, &own.columns)?;
                (own.key == key).then_some((place, index, columns))
            });
            if let Some(same) = same {
                planned.shared.push(same);
                cost.known += 1;
                continue;
            }
            planned.asked.push(Asked {
                place,
                key,
                columns: spec.columns.clone(),
            });
            let id = JobId(self.next_id);
            planned.jobs.push((id, Job::Simulate(spec)));
            self.next_id += 1;
        }
        Ok(planned)
    }
}

/// Batch of experiments as far as it is known, and the jobs of the rest.
struct Planned {
    /// Observations of the batch; `None` where they are not known.
    results: Vec<Option<Observation>>,
    /// Experiments that are simulated, in the order of their jobs.
    asked: Vec<Asked>,
    /// Places of experiments that one of `asked` answers, with its index and the places of the derivatives there.
    shared: Vec<(usize, usize, Vec<usize>)>,
    jobs: Vec<(JobId, Job)>,
}

/// Experiment of a batch that is simulated: place of its result, experiment, and derivatives.
struct Asked {
    place: usize,
    key: Key,
    columns: Vec<Column>,
}
