//! Executor of the experiments (simulations) of a diagnosis or identification as jobs of an evaluator.
//!
//! Experiments are numbered in the order in which they are requested, which depends on results alone; a
//! resumed run therefore finds all of them in its journal.
use super::{
    batch::run_batch,
    entry::{Entry, StageCost},
    error::StudyError,
    evaluator::{Evaluator, answer},
    stop::Stop,
    watch::Watch,
};
use discrepancy::baseline::budget::cost;
use discrepancy::diagnose::Inputs;
use discrepancy::laboratory::{Finding, Laboratory, Stage};
use journal::event::JobReason;
use journal::job_range::LIBRARY;
use protocol::{
    announce::EffectDescriptor,
    id::JobId,
    job::{Answer, Job, Observation, SimulateSpec, Verdict},
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

    fn found(&mut self, finding: &Finding) -> Result<(), StudyError> {
        Ok(self.evaluator.enter(&Entry::Interim(finding.clone()))?)
    }

    async fn observe(
        &mut self,
        stage: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, StudyError> {
        let mut results: Vec<Option<Observation>> = vec![None; batch.len()];
        let mut open = batch.len();
        let prices: Vec<f64> = batch.iter().map(|spec| cost(spec.columns.len())).collect();
        let numbers = (self.next_id..).map(JobId);
        let jobs = numbers.zip(batch.into_iter().map(Job::Simulate)).collect();
        self.next_id += results.len() as u64;
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
            |evaluator, place, completed| {
                let price = prices.get(place).copied().unwrap_or_default();
                *spent += price;
                left[stage as usize] -= price;
                let cost = costs.entry(stage).or_default();
                cost.experiments += 1;
                let id = completed.id;
                match completed.outcome.done() {
                    Ok(answer) => {
                        let seen = answer.into_channels();
                        let seen = seen.map_err(|_| StudyError::WrongKind { id })?;
                        cost.failed += u64::from(seen.verdict != Verdict::Complete);
                        if let Some(slot) = results.get_mut(place) {
                            *slot = Some(seen);
                        }
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
        cost.batches += u64::from(!results.is_empty());
        Ok(results)
    }
}
