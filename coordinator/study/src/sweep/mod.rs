//! Concurrent searches over one space on the same workers: while one search waits for its last results, the
//! others keep the slots busy.
//!
//! Independent of the purpose of the searches. A job is numbered by its content: an individual that several
//! searches request is computed once, and a resumed run finds all results in its journal. The result of a
//! search depends neither on the other searches nor on the order in which results arrive.
use super::{
    calibrate::{MIN_FAILED_EVALUATIONS, all_failed, anticipated, entry, reason, residual, score},
    error::StudyError,
    evaluator::Evaluator,
    job_number::JobNumbers,
    log::{EvaluationLog, EvaluationOutcome, LogEntry},
    progress::ProgressView,
    stop::{Stop, or_stop},
    watch::Watch,
};
use protocol::{case::Case, id::JobId, job::Outcome};
use search::{
    space::Space,
    strategy::{Best, Proposal, Settings, Strategy, build},
};
use std::collections::BTreeMap;

#[cfg(test)]
mod tests;

/// Number of open jobs above which no further search is begun; enough for the slots of many workers.
const BUSY: usize = 256;

/// Settings of one of the concurrent searches of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// Settings of the search strategy.
    pub settings: Settings,
    /// Seed of the random numbers of the search.
    pub seed: u64,
    /// Budget of evaluations; none for a search that ends as planned by its settings.
    pub evaluations: Option<u64>,
}

/// Result of one of the concurrent searches of a sweep.
#[derive(Clone, Debug, PartialEq)]
pub struct SearchResult {
    /// Best individual found by the search; none if there is none.
    pub best: Option<Best>,
    /// Number of evaluations, including those that other searches had already requested.
    pub evaluations: u64,
}

struct Running {
    strategy: Box<dyn Strategy>,
    /// Number of proposals that are evaluated; those with this id or a higher one are not.
    limit: u64,
}

/// Concurrent searches over one space that share their evaluation results.
pub struct Sweep<'a> {
    case: &'a Case,
    space: &'a Space,
    running: BTreeMap<usize, Running>,
    /// Results of finished searches, by number of the search; numbers continue over all calls of
    /// [`Sweep::run`].
    found: BTreeMap<usize, SearchResult>,
    /// Unfinished jobs, each with the searches (by number) and their proposals that wait for its result.
    open: BTreeMap<JobId, Vec<(usize, Proposal)>>,
    known: BTreeMap<JobId, Outcome>,
    /// Numbers of the run's jobs by their content; none before the first call of [`Sweep::run`].
    numbers: Option<JobNumbers>,
    view: ProgressView,
    /// Log of failed evaluations, kept only until the first evaluation is complete.
    failed: Option<EvaluationLog>,
}

impl<'a> Sweep<'a> {
    /// Creates a sweep over a search space, without searches yet.
    pub fn new(case: &'a Case, space: &'a Space) -> Self {
        Self {
            case,
            space,
            running: BTreeMap::new(),
            found: BTreeMap::new(),
            open: BTreeMap::new(),
            known: BTreeMap::new(),
            numbers: None,
            view: ProgressView::default(),
            failed: Some(EvaluationLog::default()),
        }
    }

    /// Runs searches to their ends; results in the order of the list. May be called again with the same
    /// evaluator; known results are not computed again.
    ///
    /// # Errors
    /// If settings are invalid, if the case or the workers make every evaluation impossible, if a whole
    /// search ends and every evaluation so far has failed, if no evaluator is left, or if the user stops it.
    pub async fn run<E: Evaluator>(
        &mut self,
        evaluator: &mut E,
        searches: &[Search],
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<Vec<SearchResult>> {
        if self.numbers.is_none() {
            self.numbers = Some(evaluator.numbers()?);
        }
        let first = self.found.len();
        let all = first + searches.len();
        self.view.generations = u32::try_from(all).unwrap_or(u32::MAX);
        let mut waiting = (first..).zip(searches);
        loop {
            while self.open.len() < BUSY
                && let Some((index, search)) = waiting.next()
            {
                let strategy = build(&search.settings, self.space, search.seed);
                let running = Running {
                    strategy: strategy.map_err(StudyError::from)?,
                    limit: search.evaluations.unwrap_or(u64::MAX),
                };
                self.running.insert(index, running);
                self.advance(evaluator, index)?;
            }
            if evaluator.computes_ahead() {
                let running = self.running.values();
                let jobs = running.map(|own| anticipated(self.case, own.strategy.as_ref()));
                evaluator.anticipate(jobs.flatten().collect())?;
            }
            self.plan(waiting.clone().filter_map(|(_, search)| search.evaluations));
            watch.progress(&self.view, &|| evaluator.snapshot());
            if self.found.len() == all {
                return Ok(self.found.values().skip(first).cloned().collect());
            }
            let completed = or_stop(evaluator.next(), stop).await??;
            let Some(asked) = self.open.remove(&completed.id) else {
                continue;
            };
            self.count(&asked, &completed.outcome, completed.replayed)?;
            let indices: Vec<usize> = asked.iter().map(|(index, _)| *index).collect();
            for (index, proposal) in asked {
                self.tell(index, proposal, completed.outcome.clone())?;
            }
            self.known.insert(completed.id, completed.outcome);
            for index in indices {
                self.advance(evaluator, index)?;
            }
        }
    }

    /// Asks a search for proposals and submits these until the search waits for results or ends.
    fn advance<E: Evaluator>(&mut self, evaluator: &mut E, index: usize) -> anyhow::Result<()> {
        while let Some(running) = self.running.get_mut(&index) {
            let strategy = running.strategy.as_mut();
            let evaluations = strategy.archive().entries().len() as u64;
            if evaluations >= running.limit || strategy.finished().is_some() {
                let best = strategy.best();
                self.running.remove(&index);
                self.found.insert(index, SearchResult { best, evaluations });
                return self.check_failed();
            }
            let limit = running.limit;
            let asked = strategy.ask().into_iter();
            let (mut new, mut told) = (false, false);
            for proposal in asked.filter(|proposal| proposal.id < limit) {
                new = true;
                let job = score(self.case, &proposal);
                let numbers = self.numbers.get_or_insert_default();
                let id = numbers.number(&job);
                if let Some(outcome) = self.known.get(&id).cloned() {
                    told = true;
                    self.tell(index, proposal, outcome)?;
                } else if let Some(asked) = self.open.get_mut(&id) {
                    asked.push((index, proposal));
                } else {
                    evaluator.submit(id, job, reason(&proposal))?;
                    self.open.insert(id, vec![(index, proposal)]);
                }
            }
            if !(new && told) {
                return Ok(());
            }
        }
        Ok(())
    }

    fn tell(
        &mut self,
        index: usize,
        proposal: Proposal,
        outcome: Outcome,
    ) -> Result<(), StudyError> {
        // others may have ended without it
        let Some(running) = self.running.get_mut(&index) else {
            return Ok(());
        };
        if let Some(residual) = residual(self.case, &proposal, &outcome) {
            running.strategy.tell_residual(proposal.id, residual);
        }
        let entry = entry(proposal, outcome)?;
        running.strategy.tell(entry.id, entry.strategy_result());
        Ok(())
    }

    /// Adds a job's result to the displayed progress, once for all searches that requested it.
    fn count(
        &mut self,
        asked: &[(usize, Proposal)],
        outcome: &Outcome,
        replayed: bool,
    ) -> Result<(), StudyError> {
        let Some((_, proposal)) = asked.first() else {
            return Ok(());
        };
        let entry = entry(proposal.clone(), outcome.clone())?;
        self.view.apply(&entry, replayed);
        if entry.ending == EvaluationOutcome::Complete {
            self.failed = None;
        } else if let Some(failed) = &mut self.failed {
            let id = failed.len() as u64;
            failed.insert(LogEntry { id, ..entry });
        }
        Ok(())
    }

    /// Fails if a whole search has ended and no evaluation was ever complete.
    fn check_failed(&self) -> anyhow::Result<()> {
        match &self.failed {
            Some(failed) if failed.len() >= MIN_FAILED_EVALUATIONS => {
                Err(all_failed(failed).into())
            }
            Some(_) | None => Ok(()),
        }
    }

    /// Updates the expected evaluations of all searches together; `waiting` holds the budgets of those that
    /// have not begun.
    fn plan(&mut self, waiting: impl Iterator<Item = u64>) {
        let running = self.running.values().map(|running| {
            let progress = running.strategy.progress();
            let all = progress.expected_evaluations.min(running.limit);
            all.saturating_sub(progress.evaluations)
        });
        let ahead: u64 = running.chain(waiting).sum();
        self.view.generation = u32::try_from(self.found.len()).unwrap_or(u32::MAX);
        self.view.expected = self.view.completed + ahead;
    }
}
