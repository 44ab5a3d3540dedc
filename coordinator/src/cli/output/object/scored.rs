//! JSON form of the result of one individual, for `horsehead evaluate` and `horsehead sweep`.
use super::{
    score::{ScoreOutput, channels},
    simulation::VerdictOutput,
};
use protocol::{
    case::Case,
    job::{Evaluation, Verdict},
};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use study::Scored;

/// JSON form of the result of one individual.
#[derive(Debug, Serialize)]
pub(crate) struct ScoredOutput {
    /// Objective of the individual; for a failed simulation a graded value above that of every complete one;
    /// null if it could not be computed.
    objective: Option<f64>,
    complete: bool,
    /// How the individual's simulation ended, or why there was none.
    #[serde(flatten)]
    verdict: VerdictOutput,
}

impl From<&Scored> for ScoredOutput {
    fn from(scored: &Scored) -> Self {
        match scored {
            Ok(evaluation) => Self {
                objective: Some(evaluation.fitness).filter(|objective| objective.is_finite()),
                complete: evaluation.verdict == Verdict::Complete,
                verdict: evaluation.verdict.into(),
            },
            Err(failure) => Self {
                objective: None,
                complete: false,
                verdict: VerdictOutput {
                    verdict: failure.to_string(),
                    load_fraction: None,
                    time_fraction: None,
                },
            },
        }
    }
}

/// JSON object printed by `horsehead sweep FILE.csv`, also written as `result.json` in the run folder.
#[derive(Debug, Serialize)]
pub(crate) struct IndividualsOutput {
    /// Results of the individuals, in the order of the user's table.
    individuals: Vec<IndividualOutput>,
}

/// Result of one individual of the user's table.
#[derive(Debug, Serialize)]
struct IndividualOutput {
    /// Values of the individual's unknowns, by name.
    genes: BTreeMap<String, f64>,
    #[serde(flatten)]
    scored: ScoredOutput,
    /// Agreement with the measured record by channel; empty if the simulation did not complete.
    channels: BTreeMap<String, ScoreOutput>,
}

impl IndividualsOutput {
    /// Builds the JSON object from the rows of a table of individuals and their results; `names` are the
    /// unknowns of the columns.
    pub(crate) fn new(case: &Case, names: &[String], rows: &[Vec<f64>], found: &[Scored]) -> Self {
        let one = |(row, scored): (&Vec<f64>, &Scored)| IndividualOutput {
            genes: names.iter().cloned().zip(row.iter().copied()).collect(),
            scored: scored.into(),
            channels: channels(case, scored.as_ref().ok()),
        };
        Self {
            individuals: rows.iter().zip(found).map(one).collect(),
        }
    }
}

/// Formats the results of individuals as a CSV table: the columns of the user's table, `objective`,
/// `verdict`, then one column `CHANNEL.SCORE` per score, empty where there is no score.
///
/// # Errors
/// If a number cannot be written.
pub(crate) fn table(
    case: &Case,
    names: &[String],
    rows: &[Vec<f64>],
    found: &[Scored],
) -> anyhow::Result<String> {
    let scores = |evaluation: &Evaluation| -> BTreeMap<String, f64> {
        let by_channel = channels(case, Some(evaluation)).into_iter();
        let flat = by_channel.flat_map(|(channel, score)| {
            let score = serde_json::to_value(score).unwrap_or_default();
            let numbers = score.as_object().cloned().unwrap_or_default().into_iter();
            numbers.filter_map(move |(name, value): (String, Value)| {
                Some((format!("{channel}.{name}"), value.as_f64()?))
            })
        });
        flat.collect()
    };
    let scored: Vec<BTreeMap<String, f64>> = found
        .iter()
        .map(|one| one.as_ref().map(scores).unwrap_or_default())
        .collect();
    let columns: BTreeSet<&String> = scored.iter().flat_map(BTreeMap::keys).collect();
    let mut writer = csv::Writer::from_writer(Vec::new());
    let fixed = ["objective", "verdict"];
    let names = names.iter().map(String::as_str);
    let header = names
        .chain(fixed)
        .chain(columns.iter().map(|name| name.as_str()));
    writer.write_record(header)?;
    for ((row, one), scores) in rows.iter().zip(found).zip(&scored) {
        let (objective, verdict) = match one {
            Ok(Evaluation {
                verdict, fitness, ..
            }) => (fitness.to_string(), ended(verdict)),
            Err(failure) => (String::new(), failure.to_string()),
        };
        let cell = |name: &&String| scores.get(*name).map_or_else(String::new, f64::to_string);
        let cells = row.iter().map(f64::to_string);
        let cells = cells.chain([objective, verdict]);
        writer.write_record(cells.chain(columns.iter().map(cell)))?;
    }
    Ok(String::from_utf8(writer.into_inner()?)?)
}

fn ended(verdict: &Verdict) -> String {
    match verdict {
        Verdict::Complete => "complete".to_owned(),
        Verdict::Failed { kind, .. } => kind.with_spaces(),
    }
}
