//! Scores and curves of selected individuals under selected conditions.
use super::{
    batch::run_batch, error::StudyError, evaluator::Evaluator, job_number::of_comparison,
    stop::Stop,
};
use journal::event::JobReason;
use protocol::{
    case::{Case, EffectSetting},
    id::JobId,
    job::{self, Column, Evaluation, Individual, Job, Numerics, Reply, SimulateSpec},
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Individuals to score and simulate under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct CompareRequest {
    /// Index of the condition in the case under which the individuals are compared.
    pub condition: usize,
    /// Number of individuals already compared under this condition in the run, i.e. index of the first of
    /// these; determines the job numbers.
    pub first: usize,
    /// Individuals to compare.
    pub individuals: Vec<NamedIndividual>,
    /// Number of motion snapshots recorded per simulation; 0 for none.
    pub frames: u32,
    /// Unknowns and effect parameters by which the curves are differentiated.
    pub columns: Vec<Column>,
}

/// Individual to compare, with its name.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NamedIndividual {
    /// Name of the individual in results and messages.
    pub name: String,
    /// Values of the unknowns in declared units, in the case's order.
    pub genes: Vec<f64>,
    /// Effects beside or in place of those of the case.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub effects: Vec<EffectSetting>,
    /// Numerical settings in place of those of the case.
    #[serde(default)]
    pub numerics: Numerics,
}

impl NamedIndividual {
    /// Creates an individual with the effects of the case.
    pub fn new(name: impl Into<String>, genes: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            genes,
            effects: Vec::new(),
            numerics: Numerics::FROM_CASE,
        }
    }

    fn under(&self, condition: usize) -> Individual {
        Individual {
            effects: self.effects.clone(),
            ..Individual::new(condition, self.genes.clone())
        }
    }
}

/// Purpose of jobs that compare selected individuals.
const COMPARISON: &str = "comparison";

/// Number of motion snapshots per simulation that suffices for a smooth animation.
pub const PICTURES: u32 = 120;

/// Score and curves of one individual under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedCurves {
    /// Name of the compared individual.
    pub name: String,
    /// Values of the individual's unknowns in declared units.
    pub genes: Vec<f64>,
    /// Score against the measured record; none where the condition has no record.
    pub evaluation: Option<Evaluation>,
    /// Simulated curves of the individual; they end where the simulation ended early.
    pub drawn: job::Curves,
}

/// Scores and curves of all compared individuals under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Index in the case of the condition under which the individuals were simulated.
    pub condition: usize,
    /// Scores and curves of the individuals, in the order of the request.
    pub individuals: Vec<ComparedCurves>,
}

#[derive(Default)]
struct Pair {
    evaluation: Option<Evaluation>,
    drawn: Option<job::Curves>,
}

/// Scores every individual, where there is a measured record, and simulates it. The job numbers depend only
/// on condition and position, so that a resumed run finds its results in the journal.
///
/// # Errors
/// If a job cannot be done, no evaluator is left, or the user stops it. A simulation that ends early is a
/// result, not an error.
pub async fn compare<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    wanted: &[CompareRequest],
    stop: &mut Stop,
) -> Result<Vec<Compared>, StudyError> {
    let (mut jobs, mut places) = (Vec::new(), Vec::new());
    for (group, one) in wanted.iter().enumerate() {
        let recorded = case.is_measured(one.condition);
        for (position, own) in one.individuals.iter().enumerate() {
            let first = of_comparison(one.condition, one.first + position);
            let spec = |reply| SimulateSpec {
                numerics: own.numerics.clone(),
                ..SimulateSpec::new(own.under(one.condition), reply)
            };
            if recorded {
                let reply = Reply::Score {
                    with_residual: false,
                    whole: false,
                };
                jobs.push((JobId(first), Job::Simulate(spec(reply))));
                places.push((group, position));
            }
            let reply = Reply::Curves {
                pictures: one.frames,
            };
            let spec = SimulateSpec {
                columns: one.columns.clone(),
                ..spec(reply)
            };
            jobs.push((JobId(first + 1), Job::Simulate(spec)));
            places.push((group, position));
        }
    }
    let mut pairs: BTreeMap<(usize, usize), Pair> = BTreeMap::new();
    let reason = JobReason::outside_search(COMPARISON);
    run_batch(evaluator, jobs, &reason, stop, |_, number, completed| {
        let place = places.get(number).copied().unwrap_or_default();
        let pair = pairs.entry(place).or_default();
        let id = completed.id;
        let answer = completed.outcome.done();
        let answer =
            answer.map_err(|failure| StudyError::of(failure, || name(case, wanted, place)))?;
        let wrong = |_| StudyError::WrongKind { id };
        if answer.evaluation().is_some() {
            pair.evaluation = Some(answer.into_scored().map_err(wrong)?);
        } else {
            pair.drawn = Some(*answer.into_curves().map_err(wrong)?);
        }
        Ok(())
    })
    .await?;
    let groups = wanted.iter().enumerate();
    groups
        .map(|(group, one)| collect(one, group, &mut pairs))
        .collect()
}

fn name(case: &Case, wanted: &[CompareRequest], (group, position): (usize, usize)) -> String {
    let one = wanted.get(group);
    let condition = one.and_then(|one| case.conditions.get(one.condition));
    let individual = one.and_then(|one| one.individuals.get(position));
    let condition = condition.map_or("?", |condition| condition.name.as_str());
    let individual = individual.map_or("?", |individual| individual.name.as_str());
    format!("the {individual} individual at {condition}")
}

fn collect(
    one: &CompareRequest,
    group: usize,
    pairs: &mut BTreeMap<(usize, usize), Pair>,
) -> Result<Compared, StudyError> {
    let mut individuals = Vec::with_capacity(one.individuals.len());
    for (position, own) in one.individuals.iter().enumerate() {
        let pair = pairs.remove(&(group, position)).unwrap_or_default();
        let id = JobId(of_comparison(one.condition, one.first + position) + 1);
        let drawn = pair.drawn.ok_or(StudyError::WrongKind { id })?;
        individuals.push(ComparedCurves {
            name: own.name.clone(),
            genes: own.genes.clone(),
            evaluation: pair.evaluation,
            drawn,
        });
    }
    Ok(Compared {
        condition: one.condition,
        individuals,
    })
}
