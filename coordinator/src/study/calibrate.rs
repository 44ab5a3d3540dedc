//! The loop: ask, submit, wait, tell.
use super::{Ending, Entry, EvaluationLog, Evaluator, ProgressView, StudyError};
use protocol::{
    case::Case,
    job::{Job, Outcome, ScoreSpec},
};
use search::strategy::{Best, Finish, Proposal, Purpose, Strategy};
use std::collections::BTreeMap;
use tokio::sync::watch;

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

/// Watches a calibration.
pub trait Observe {
    /// An evaluation came back, or the search planned anew.
    fn progress(&mut self, view: &ProgressView, crew: &dyn Fn() -> super::Crew);

    /// Before anything else: how many results an earlier session left.
    fn resumed(&mut self, _recorded: usize) {}

    /// An individual is going to be evaluated.
    fn asked(&mut self, _proposal: &Proposal) {}
}

/// Becomes true when the user wants to stop.
pub type Stop = watch::Receiver<bool>;

/// Runs a search to its end; proposals are submitted under their own ids.
///
/// # Errors
/// If the case or the workers make every evaluation impossible, if the whole initial population
/// fails, if nobody evaluates any more, or if the user stops it.
pub async fn calibrate<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    strategy: &mut dyn Strategy,
    observer: &mut dyn Observe,
    stop: &mut Stop,
) -> Result<Calibrated, StudyError> {
    let mut open: BTreeMap<u64, Proposal> = BTreeMap::new();
    let mut log = EvaluationLog::default();
    let mut view = ProgressView::default();
    loop {
        for proposal in strategy.ask() {
            observer.asked(&proposal);
            evaluator.submit(proposal.id, score(case, &proposal))?;
            open.insert(proposal.id, proposal);
        }
        view.plan(&strategy.progress());
        observer.progress(&view, &|| evaluator.crew());
        if let (Some(finish), Some(best)) = (strategy.finished(), strategy.best()) {
            return Ok(Calibrated { best, finish, log });
        }
        let completed = or_stop(evaluator.next(), stop).await??;
        let Some(proposal) = open.remove(&completed.id) else {
            continue;
        };
        if let Outcome::Scored(evaluation) = &completed.outcome
            && !evaluation.residual_mpa.is_empty()
        {
            strategy.tell_residual(proposal.id, evaluation.residual_mpa.clone());
        }
        let entry = entry(proposal, completed.outcome)?;
        strategy.tell(entry.id, entry.told());
        view.apply(&entry, completed.replayed);
        log.insert(entry);
        check_initial(&log, &open)?;
    }
}

/// A future's result, unless the user stops first.
pub(super) async fn or_stop<T>(
    future: impl Future<Output = T>,
    stop: &mut Stop,
) -> Result<T, StudyError> {
    let stopped = async {
        // a sender that is gone can no longer stop anything
        if stop.wait_for(|stopped| *stopped).await.is_err() {
            std::future::pending::<()>().await;
        }
    };
    tokio::select! {
        biased;
        () = stopped => Err(StudyError::Interrupted),
        result = future => Ok(result),
    }
}

fn score(case: &Case, proposal: &Proposal) -> Job {
    Job::Score(ScoreSpec {
        condition: case.objective.condition,
        genes: proposal.genes.clone(),
        effects: Vec::new(),
        with_residual: proposal.purpose.wants_residual(),
    })
}

/// What came back of a proposal. A failure that every other individual would meet too ends the
/// study; one that concerns this individual alone makes it the worst of all.
fn entry(proposal: Proposal, outcome: Outcome) -> Result<Entry, StudyError> {
    match outcome {
        Outcome::Scored(evaluation) => Ok(Entry::scored(proposal, &evaluation)),
        Outcome::Failed(failure) => match StudyError::hopeless(&failure) {
            Some(error) => Err(error),
            None => Ok(Entry::lost(proposal, failure)),
        },
        Outcome::Simulated(_)
        | Outcome::Observed(_)
        | Outcome::Described(_)
        | Outcome::HeadReduced(_)
        | Outcome::Nothing(_) => Err(StudyError::WrongKind { id: proposal.id }),
    }
}

/// Nothing can be bred from a population in which everything failed; the search would go on, but
/// a case or a machine that is set up wrongly is by far the more likely reason.
fn check_initial(log: &EvaluationLog, open: &BTreeMap<u64, Proposal>) -> Result<(), StudyError> {
    let initial_open = open
        .values()
        .any(|proposal| proposal.purpose == Purpose::Initial);
    let all_failed = log.entries().all(|entry| entry.ending != Ending::Complete);
    if initial_open || !all_failed {
        return Ok(());
    }
    let (how, physics) = log.failures();
    Err(StudyError::AllFailed {
        count: log.len(),
        how,
        physics,
    })
}
