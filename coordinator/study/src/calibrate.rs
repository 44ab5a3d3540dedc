//! Search loop: asks the strategy for proposals, submits them as jobs, waits for results, and reports these
//! to the strategy.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    log::{EvaluationLog, EvaluationOutcome, LogEntry},
    progress::ProgressView,
    stop::{Stop, or_stop},
    watch::Watch,
};
use journal::event::JobReason;
use protocol::{
    case::Case,
    id::JobId,
    job::{Answer, Column, Individual, Job, Outcome, Reply, SimulateSpec},
};
use search::strategy::{
    Best, DescentEnd, Finish, Proposal, ProposalDraft, Purpose, Residual, Strategy,
};
use std::collections::BTreeMap;

/// Minimum number of evaluated individuals before a search in which all have failed is given up.
pub(super) const MIN_FAILED_EVALUATIONS: usize = 8;

/// Result of a finished search.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibrated {
    /// Best individual found by the search.
    pub best: Best,
    /// Stopping criterion that ended the search.
    pub finish: Finish,
    /// Ends of the search's least-squares descents that converged.
    pub descent_ends: Vec<DescentEnd>,
    /// Log of all evaluations of the search, in index order.
    pub log: EvaluationLog,
}

/// Runs a search to its end; the id of a proposal is the number of its job.
///
/// # Errors
/// If the case or the workers make every evaluation impossible, if the whole first generation fails, if no
/// evaluator is left, or if the user stops it.
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
            let job = score(case, &proposal);
            evaluator.submit(JobId(proposal.id), job, reason(&proposal))?;
            open.insert(proposal.id, proposal);
        }
        if evaluator.computes_ahead() {
            evaluator.anticipate(anticipated(case, strategy))?;
        }
        view.plan(&strategy.progress());
        watch.progress(&view, &|| evaluator.snapshot());
        if let (Some(finish), Some(best)) = (strategy.finished(), strategy.best()) {
            // which further results have come depends on the order of arrival
            log.truncate(strategy.archive().entries().len() as u64);
            return if best.complete {
                Ok(Calibrated {
                    best,
                    finish,
                    descent_ends: strategy.descent_ends().to_vec(),
                    log,
                })
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
        strategy.tell(entry.id, entry.strategy_result());
        view.apply(&entry, completed.replayed);
        log.insert(entry);
        check_beginning(&log, &open)?;
    }
}

/// Returns the reason for which a proposal is simulated.
pub(super) fn reason(proposal: &Proposal) -> JobReason {
    JobReason {
        purpose: proposal.purpose.as_str().to_owned(),
        generation: Some(proposal.generation),
    }
}

/// Builds the simulation job that scores a proposed individual.
pub(super) fn score(case: &Case, proposal: &Proposal) -> Job {
    score_for(case, &proposal.genes, proposal.purpose)
}

/// Builds the jobs of the individuals that a strategy will probably propose next, likeliest first.
pub(super) fn anticipated(case: &Case, strategy: &dyn Strategy) -> Vec<Job> {
    let drafts = strategy.anticipate().into_iter();
    let job = |draft: ProposalDraft| score_for(case, &draft.genes, draft.purpose);
    drafts.map(job).collect()
}

fn score_for(case: &Case, genes: &[f64], purpose: Purpose) -> Job {
    let individual = Individual::new(case.objective.condition, genes.to_vec());
    let reply = Reply::Score {
        with_residual: purpose.wants_residual(),
        whole: true,
    };
    Job::Simulate(SimulateSpec {
        columns: derived(case, purpose),
        ..SimulateSpec::new(individual, reply)
    })
}

/// Returns the derivative columns that a job requests for a purpose: one for each unknown that is neither
/// fixed nor switched off, or none if the purpose needs no derivatives.
fn derived(case: &Case, purpose: Purpose) -> Vec<Column> {
    let wanted = purpose.wants_derivatives();
    let moving = case.unknowns.iter().filter(|it| !it.fixed && !it.is_off());
    let columns = moving.map(|unknown| Column::new(unknown.name.clone()));
    columns.filter(|_| wanted).collect()
}

/// Returns the residual and its derivatives by name, if the job of the proposal requested and returned them.
pub(super) fn residual(case: &Case, proposal: &Proposal, outcome: &Outcome) -> Option<Residual> {
    let evaluation = outcome.answer().and_then(Answer::evaluation)?;
    let by = derived(case, proposal.purpose).into_iter();
    let by = by.map(|column| column.name).zip(evaluation.columns.clone());
    (!evaluation.residual.is_empty()).then(|| Residual {
        values: evaluation.residual.clone(),
        derivatives: by.collect(),
    })
}

/// Converts the outcome of a proposal into a log entry. A failure that would affect every other individual
/// becomes an error, which ends the study; a failure of this individual alone gives it the worst fitness.
pub(super) fn entry(proposal: Proposal, outcome: Outcome) -> Result<LogEntry, StudyError> {
    match outcome {
        Outcome::Done(answer) => match answer.into_scored() {
            Ok(evaluation) => Ok(LogEntry::scored(proposal, &evaluation)),
            Err(_) => Err(StudyError::WrongKind {
                id: JobId(proposal.id),
            }),
        },
        Outcome::Failed(failure) => match StudyError::from_systematic_failure(&failure) {
            Some(error) => Err(error),
            None => Ok(LogEntry::lost(proposal, failure)),
        },
    }
}

/// Returns an error if the first generation is complete and all evaluations so far have failed: a wrongly
/// configured case or machine is then by far the most likely reason.
fn check_beginning(log: &EvaluationLog, open: &BTreeMap<u64, Proposal>) -> Result<(), StudyError> {
    if log
        .entries()
        .any(|entry| entry.ending == EvaluationOutcome::Complete)
    {
        return Ok(());
    }
    let tried = log.entries().map(|entry| entry.generation);
    let untried = open.values().map(|proposal| proposal.generation);
    let first = tried.chain(untried.clone()).min();
    if log.len() < MIN_FAILED_EVALUATIONS || untried.min().is_some_and(|open| Some(open) == first) {
        return Ok(());
    }
    Err(all_failed(log))
}

pub(super) fn all_failed(log: &EvaluationLog) -> StudyError {
    let (how, physics) = log.failures();
    let of_program = log.entries().any(|entry| match &entry.ending {
        EvaluationOutcome::Infrastructure(failure) => failure.is_of_program(),
        EvaluationOutcome::Complete | EvaluationOutcome::Physics(_) => false,
    });
    StudyError::AllFailed {
        count: log.len(),
        how,
        physics,
        of_program,
    }
}
