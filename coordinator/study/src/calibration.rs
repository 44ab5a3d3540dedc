//! Whole calibration: the recommended individual, the search, and the comparison of both individuals; and the same
//! result read from a journal.
use super::{
    calibrate::{Calibrated, MIN_FAILED_EVALUATIONS, all_failed, calibrate, entry},
    compare::{CompareRequest, Compared, ComparedCurves, NamedIndividual, PICTURES, compare},
    entry::Entry,
    error::StudyError,
    evaluator::Evaluator,
    job_number::{compared_individual, proposal_number},
    log::EvaluationLog,
    mismatch::{mismatches, recommended},
    progress::ProgressView,
    recorded::{RecordError, read_entries},
    stop::Stop,
    watch::Watch,
};
use discrepancy::identify::UnknownEstimate;
use journal::{
    Answers,
    account::{AccountBuilder, Costs, JobCost, RunAccount},
    event::{Asked, Event, Finished},
};
use protocol::{
    case::Case,
    job::{Curves, Evaluation, Outcome},
};
use search::strategy::{Proposal, Purpose, Strategy};
use std::{collections::BTreeMap, path::Path};

/// Names of the compared individuals, in the order in which they are compared.
const COMPARED: [&str; 2] = ["recommended", "optimised"];

/// Result of a whole calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct CalibrationResult {
    /// Best individual and evaluation log of the search.
    pub calibrated: Calibrated,
    /// Comparisons of the recommended and the best individual, the calibrated condition first.
    pub compared: Vec<Compared>,
    /// Notes about records that do not fit their channels.
    pub notes: Vec<String>,
}

/// Simulates the recommended individual, runs the search, and compares the recommended with the best individual; enters
/// notes and result.
///
/// # Errors
/// As [`calibrate()`] and [`compare()`].
pub async fn calibrate_case<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    strategy: &mut dyn Strategy,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> Result<CalibrationResult, StudyError> {
    let wanted = recommended(case, PICTURES);
    // workers may be long in coming
    let mut view = ProgressView::default();
    let plan = strategy.progress();
    evaluator.enter(&Entry::Planned {
        generations: plan.generations,
        evaluations: plan.expected_evaluations,
    })?;
    view.plan(&plan);
    watch.progress(&view, &|| evaluator.snapshot());
    let first = match compare(evaluator, case, &wanted, stop).await {
        // others may do better; without a comparison there is no report
        Err(error @ StudyError::Unavailable { .. }) => Err(error),
        other => Ok(other?),
    };
    let notes = first.as_ref().map(|all| mismatches(case, &[], all));
    let notes = notes.unwrap_or_default();
    watch.noted(&notes);
    evaluator.enter(&Entry::Noted(notes.clone()))?;
    let calibrated = calibrate(evaluator, case, strategy, watch, stop).await?;
    let first = first?;
    let best = |one: CompareRequest| CompareRequest {
        first: 1,
        individuals: vec![NamedIndividual::new(
            COMPARED[1],
            calibrated.best.genes.clone(),
        )],
        ..one
    };
    let wanted: Vec<CompareRequest> = wanted.into_iter().map(best).collect();
    let optimised = compare(evaluator, case, &wanted, stop).await?;
    let both = first.into_iter().zip(optimised);
    let both = both.map(|(mut recommended, optimised)| {
        recommended.individuals.extend(optimised.individuals);
        recommended
    });
    evaluator.enter(&Entry::Calibrated {
        best: calibrated.best.clone(),
        finish: calibrated.finish,
        descent_ends: calibrated.descent_ends.clone(),
        evaluations: calibrated.log.len() as u64,
        digest: calibrated.log.digest(),
    })?;
    Ok(CalibrationResult {
        calibrated,
        compared: both.collect(),
        notes,
    })
}

/// Calibration as its journal states it: its result, and what it took.
#[derive(Clone, Debug, PartialEq)]
pub struct RecordedCalibration {
    /// Result of the calibration.
    pub result: CalibrationResult,
    /// First-order estimates of the unknowns; empty where they cannot be estimated.
    pub estimates: Vec<UnknownEstimate>,
    /// Use of the workers over all processes of the run.
    pub account: RunAccount,
    /// Cost of each job.
    pub costs: Costs,
}

/// Reads a finished calibration of a case from its journal. Nothing is simulated or searched.
///
/// # Errors
/// [`RecordError`] if the journal cannot be read, the calibration has not been finished, or results are missing.
pub fn read_calibration(path: &Path, case: &Case) -> Result<RecordedCalibration, RecordError> {
    let (mut reading, mut answers) = (CalibrationReader::default(), Answers::default());
    let (mut account, mut costs) = (AccountBuilder::default(), Costs::new());
    let (entries, damage) = read_entries(path, |event| {
        account.apply(&event);
        if let Event::Finished(finished) = &event {
            let cost = JobCost::of(finished);
            costs.entry(finished.job().0).or_insert(cost);
        }
        if let Some((asked, finished)) = answers.pair(event) {
            reading.answer(asked, finished);
        }
    })?;
    let (result, estimates) = reading.result(case, entries)?;
    Ok(RecordedCalibration {
        result,
        estimates,
        account: account.finish(damage),
        costs,
    })
}

/// Fold of the requests of a calibration and their results, in the order of the journal.
#[derive(Clone, Debug, Default)]
pub struct CalibrationReader {
    log: EvaluationLog,
    /// Scores and curves of compared individuals by condition and position.
    scores: BTreeMap<(usize, usize), Evaluation>,
    curves: BTreeMap<(usize, usize), (Vec<f64>, Curves)>,
}

impl CalibrationReader {
    /// Returns the evaluations so far.
    pub const fn log(&self) -> &EvaluationLog {
        &self.log
    }

    /// Returns why the search has ended without a result; `None` if an individual completed, or too few were evaluated.
    pub fn failure(&self) -> Option<StudyError> {
        let is_begun = self.log.len() >= MIN_FAILED_EVALUATIONS;
        (is_begun && self.log.failed() == self.log.len()).then(|| all_failed(&self.log))
    }

    /// Returns what was simulated of an individual of the comparison under a condition; `None` if it is none, or its curves
    /// have not arrived.
    pub fn compared(&self, condition: usize, genes: &[f64]) -> Option<ComparedCurves> {
        let same = |own: &[f64]| {
            let pairs = own.iter().zip(genes);
            own.len() == genes.len() && pairs.into_iter().all(|(a, b)| a.to_bits() == b.to_bits())
        };
        (0..COMPARED.len()).find_map(|position| {
            let place = (condition, position);
            let (own, drawn) = self.curves.get(&place).filter(|(own, _)| same(own))?;
            Some(ComparedCurves {
                name: COMPARED[position].to_owned(),
                genes: own.clone(),
                evaluation: self.scores.get(&place).cloned(),
                drawn: drawn.clone(),
            })
        })
    }

    /// Takes a requested job with its result.
    pub fn answer(&mut self, asked: Asked, finished: Finished) {
        let id = asked.job;
        let genes = asked.individual.map(|own| own.genes).unwrap_or_default();
        if let Some(place) = compared_individual(id) {
            let Outcome::Done(answer) = finished.outcome else {
                return;
            };
            if answer.evaluation().is_some() {
                self.scores
                    .extend(answer.into_scored().ok().map(|own| (place, own)));
            } else if let Ok(curves) = answer.into_curves() {
                self.curves.insert(place, (genes, *curves));
            }
        } else if let Some((id, purpose)) =
            proposal_number(id).zip(Purpose::named(&asked.reason.purpose))
        {
            let proposal = Proposal {
                id,
                genes,
                generation: asked.reason.generation.unwrap_or_default(),
                purpose,
            };
            // a failure that ends a study is not followed by a conclusion
            if let Ok(entry) = entry(proposal, finished.outcome) {
                self.log.insert(entry);
            }
        }
    }

    /// Returns the result of the calibration, and the estimates of its unknowns.
    fn result(
        mut self,
        case: &Case,
        entries: Vec<Entry>,
    ) -> Result<(CalibrationResult, Vec<UnknownEstimate>), RecordError> {
        let mut all_notes = Vec::new();
        let (mut concluded, mut estimated) = (None, None);
        for entry in entries {
            match entry {
                Entry::Noted(notes) => all_notes.extend(notes),
                Entry::Calibrated {
                    best,
                    finish,
                    descent_ends,
                    evaluations,
                    digest,
                } => {
                    self.log.truncate(evaluations);
                    concluded = Some((best, finish, descent_ends, digest));
                }
                Entry::Estimated(estimates) => estimated = Some(estimates),
                Entry::Record(_)
                | Entry::Planned { .. }
                | Entry::Budgeted(_)
                | Entry::Interim(_)
                | Entry::Diagnosed(_)
                | Entry::Identified(_)
                | Entry::Swept(_)
                | Entry::Tested(_)
                | Entry::Table { .. } => {}
            }
        }
        let (concluded, estimates) = concluded.zip(estimated).ok_or(RecordError::Unfinished)?;
        let (best, finish, descent_ends, digest) = concluded;
        if self.log.digest() != digest {
            return Err(RecordError::Incomplete);
        }
        let (mut scores, mut curves) = (self.scores, self.curves);
        let mut compared = Vec::new();
        for CompareRequest { condition, .. } in recommended(case, 0) {
            let mut individuals = Vec::new();
            for (position, name) in COMPARED.into_iter().enumerate() {
                let place = (condition, position);
                let (genes, drawn) = curves.remove(&place).ok_or(RecordError::Incomplete)?;
                let evaluation = scores.remove(&place);
                if evaluation.is_none() && case.is_measured(condition) {
                    return Err(RecordError::Incomplete);
                }
                individuals.push(ComparedCurves {
                    name: name.to_owned(),
                    genes,
                    evaluation,
                    drawn,
                });
            }
            compared.push(Compared {
                condition,
                individuals,
            });
        }
        let result = CalibrationResult {
            calibrated: Calibrated {
                best,
                finish,
                descent_ends,
                log: self.log,
            },
            compared,
            notes: all_notes,
        };
        Ok((result, estimates))
    }
}
