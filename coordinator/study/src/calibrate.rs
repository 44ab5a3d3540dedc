//! The loop: ask, submit, wait, tell.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    log::{Ending, Entry, EvaluationLog},
    progress::ProgressView,
    stop::{Stop, or_stop},
    watch::Watch,
};
use protocol::{
    case::Case,
    id::JobId,
    job::{Answer, Column, Individual, Job, Outcome, Reply, SimulateSpec},
};
use search::strategy::{Best, Finish, Proposal, Residual, Strategy};
use std::collections::BTreeMap;

/// Individuals that must have failed before a search is given up because nothing else has happened.
pub(super) const LEAST_TRIED: usize = 8;

/// A finished search.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// The best individual.
    pub best: Best,
    /// Why the search ended.
    pub finish: Finish,
    /// Every evaluation in index order.
    pub log: EvaluationLog,
}

/// Runs a search to its end; proposals are submitted under their own ids.
///
/// # Errors
/// If the case or the workers make every evaluation impossible, if everything that
/// the search begins with fails, if nobody evaluates any more, or if the user stops it.
pub async fn calibrate<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    strategy: &mut dyn Strategy,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> Result<Calibrated, StudyError> {
    let mut open: BTreeMap<u64, Proposal> = BTreeMap::new();
    let mut log = EvaluationLog::default();
    let mut view = ProgressView::default();
    loop {
        for proposal in strategy.ask() {
            watch.asked(proposal.id, &proposal);
            evaluator.submit(JobId(proposal.id), score(case, &proposal))?;
            open.insert(proposal.id, proposal);
        }
        view.plan(&strategy.progress());
        watch.progress(&view, &|| evaluator.crew());
        if let (Some(finish), Some(best)) = (strategy.finished(), strategy.best()) {
            return if best.complete {
                Ok(Calibrated { best, finish, log })
            } else {
                Err(all_failed(&log))
            };
        }
        let completed = or_stop(evaluator.next(), stop).await??;
        let Some(proposal) = open.remove(&completed.id.0) else {
            continue;
        };
        if let Some(residual) = residual(case, &proposal, &completed.outcome) {
            strategy.tell_residual(proposal.id, residual);
        }
        let entry = entry(proposal, completed.outcome)?;
        strategy.tell(entry.id, entry.told());
        view.apply(&entry, completed.replayed);
        log.insert(entry);
        check_beginning(&log, &open)?;
    }
}

/// The job of a proposal.
pub(super) fn score(case: &Case, proposal: &Proposal) -> Job {
    let individual = Individual::new(case.objective.condition, proposal.genes.clone());
    let reply = Reply::Score {
        with_residual: proposal.purpose.wants_residual(),
        whole: true,
    };
    Job::Simulate(SimulateSpec {
        columns: derived(case, proposal),
        ..SimulateSpec::new(individual, reply)
    })
}

/// What a proposal is to be differentiated by: every unknown that moves.
fn derived(case: &Case, proposal: &Proposal) -> Vec<Column> {
    let wanted = proposal.purpose.wants_derivatives();
    let moving = case.unknowns.iter().filter(|it| !it.fixed && !it.is_off());
    let columns = moving.map(|unknown| Column::of(unknown.name.clone()));
    columns.filter(|_| wanted).collect()
}

/// The residual of a proposal whose job wanted one and brought it, with its derivatives by name.
pub(super) fn residual(case: &Case, proposal: &Proposal, outcome: &Outcome) -> Option<Residual> {
    let evaluation = outcome.answer().and_then(Answer::evaluation)?;
    let by = derived(case, proposal).into_iter();
    let by = by.map(|column| column.name).zip(evaluation.columns.clone());
    (!evaluation.residual.is_empty()).then(|| Residual {
        values: evaluation.residual.clone(),
        by: by.collect(),
    })
}

/// What came back of a proposal. A failure that every other individual would meet too ends the
/// study; one that concerns this individual alone makes it the worst of all.
pub(super) fn entry(proposal: Proposal, outcome: Outcome) -> Result<Entry, StudyError> {
    match outcome {
        Outcome::Done(answer) => match answer.into_scored() {
            Ok(evaluation) => Ok(Entry::scored(proposal, &evaluation)),
            Err(_) => Err(StudyError::WrongKind {
                id: JobId(proposal.id),
            }),
        },
        Outcome::Failed(failure) => match StudyError::hopeless(&failure) {
            Some(error) => Err(error),
            None => Ok(Entry::lost(proposal, failure)),
        },
    }
}

/// Whether nothing is open any more of what the search began with, its first generation, and all that
/// has come back failed. The search might go on, but a case or a machine that is set up wrongly is by
/// far the more likely reason.
fn check_beginning(log: &EvaluationLog, open: &BTreeMap<u64, Proposal>) -> Result<(), StudyError> {
    if log.entries().any(|entry| entry.ending == Ending::Complete) {
        return Ok(());
    }
    let tried = log.entries().map(|entry| entry.generation);
    let untried = open.values().map(|proposal| proposal.generation);
    let first = tried.chain(untried.clone()).min();
    if log.len() < LEAST_TRIED || untried.min().is_some_and(|open| Some(open) == first) {
        return Ok(());
    }
    Err(all_failed(log))
}

pub(super) fn all_failed(log: &EvaluationLog) -> StudyError {
    let (how, physics) = log.failures();
    StudyError::AllFailed {
        count: log.len(),
        how,
        physics,
    }
}
