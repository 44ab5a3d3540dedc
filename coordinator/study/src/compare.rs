//! Scores and curves of chosen parameter sets under chosen conditions.
use super::{
    error::StudyError,
    evaluator::Evaluator,
    job_number::of_comparison,
    stop::{Stop, or_stop},
};
use protocol::{
    case::Case,
    id::JobId,
    job::{self, Column, Evaluation, Individual, Job, Reply, SimulateSpec},
};
use std::collections::BTreeMap;

/// What is wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Wanted {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Position of the first parameter set among all of this condition in the run: a job is numbered by it.
    pub first: usize,
    /// Parameter sets, by name; gene values in declared units.
    pub individuals: Vec<(String, Vec<f64>)>,
    /// Pictures of what moves; 0 for none.
    pub pictures: u32,
    /// What the curves are differentiated by.
    pub columns: Vec<Column>,
}

/// Pictures that show what moves without a jerk.
pub const PICTURES: u32 = 120;

/// One parameter set under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// Its name.
    pub name: String,
    /// Gene values in declared units.
    pub genes: Vec<f64>,
    /// Agreement with the record; none where the condition has no record.
    pub evaluation: Option<Evaluation>,
    /// The curves, as far as the simulation got.
    pub drawn: job::Curves,
}

/// All parameter sets under one condition.
#[derive(Clone, Debug, PartialEq)]
pub struct Compared {
    /// Index of the condition in the case.
    pub condition: usize,
    /// In the order in which they were wanted.
    pub individuals: Vec<Curves>,
}

/// The two results of one parameter set, as they come in.
#[derive(Default)]
struct Pair {
    evaluation: Option<Evaluation>,
    drawn: Option<job::Curves>,
}

/// Has every parameter set scored, where there is a record, and simulated. The id of each job
/// depends only on condition and position, so a run that is opened again finds its results.
///
/// # Errors
/// If a job cannot be done, nobody evaluates any more, or the user stops it. A simulation that
/// ends early is a result, not an error.
pub async fn compare<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    wanted: &[Wanted],
    stop: &mut Stop,
) -> Result<Vec<Compared>, StudyError> {
    let mut open: BTreeMap<u64, (usize, usize)> = BTreeMap::new();
    for (group, one) in wanted.iter().enumerate() {
        let recorded = case.is_measured(one.condition);
        for (position, (_, genes)) in one.individuals.iter().enumerate() {
            let first = of_comparison(one.condition, one.first + position);
            if recorded {
                let individual = Individual::new(one.condition, genes.clone());
                let reply = Reply::Score {
                    with_residual: false,
                    whole: false,
                };
                let spec = SimulateSpec::new(individual, reply);
                evaluator.submit(JobId(first), Job::Simulate(spec))?;
                open.insert(first, (group, position));
            }
            let reply = Reply::Curves {
                pictures: one.pictures,
            };
            let individual = Individual::new(one.condition, genes.clone());
            let spec = SimulateSpec {
                columns: one.columns.clone(),
                ..SimulateSpec::new(individual, reply)
            };
            evaluator.submit(JobId(first + 1), Job::Simulate(spec))?;
            open.insert(first + 1, (group, position));
        }
    }
    let mut pairs: BTreeMap<(usize, usize), Pair> = BTreeMap::new();
    while !open.is_empty() {
        let completed = or_stop(evaluator.next(), stop).await??;
        let Some(place) = open.remove(&completed.id.0) else {
            continue;
        };
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
    }
    let groups = wanted.iter().enumerate();
    groups
        .map(|(group, one)| collect(one, group, &mut pairs))
        .collect()
}

fn name(case: &Case, wanted: &[Wanted], (group, position): (usize, usize)) -> String {
    let one = wanted.get(group);
    let condition = one.and_then(|one| case.conditions.get(one.condition));
    let individual = one.and_then(|one| one.individuals.get(position));
    let condition = condition.map_or("?", |condition| condition.name.as_str());
    let individual = individual.map_or("?", |(name, _)| name.as_str());
    format!("the {individual} individual at {condition}")
}

fn collect(
    one: &Wanted,
    group: usize,
    pairs: &mut BTreeMap<(usize, usize), Pair>,
) -> Result<Compared, StudyError> {
    let mut individuals = Vec::with_capacity(one.individuals.len());
    for (position, (name, genes)) in one.individuals.iter().enumerate() {
        let pair = pairs.remove(&(group, position)).unwrap_or_default();
        let id = JobId(of_comparison(one.condition, one.first + position) + 1);
        let drawn = pair.drawn.ok_or(StudyError::WrongKind { id })?;
        individuals.push(Curves {
            name: name.clone(),
            genes: genes.clone(),
            evaluation: pair.evaluation,
            drawn,
        });
    }
    Ok(Compared {
        condition: one.condition,
        individuals,
    })
}
