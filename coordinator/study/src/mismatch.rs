//! Consistency of measured records with their channels: a sensor of reversed sign or exchanged columns cause
//! a bad fit whose numbers do not reveal the reason.
use super::{
    compare::{CompareRequest, Compared, ComparedCurves, compare},
    error::StudyError,
    evaluator::Evaluator,
    stop::Stop,
};
use protocol::{
    case::{Case, Channel},
    job::Verdict,
};

/// Minimum amount by which a record must correlate better with another curve than with its own channel. Each
/// of 28 records of the shipped and the practice cases correlates by at least 0.97 with its own channel under
/// the recommended values, and by at most 0.86 with any other, with either sign, except for two channels that
/// mirror each other.
const MARGIN: f64 = 0.2;

/// Minimum correlation between a record and another curve from which the record is reported as belonging to
/// that curve.
const ALIKE: f64 = 0.8;

/// Returns requests for the recommended individual under the calibrated condition, with `pictures` snapshots
/// of its motion, followed by every other condition with a measured record.
pub fn recommended(case: &Case, pictures: u32) -> Vec<CompareRequest> {
    let calibrated = case.objective.condition;
    let mut conditions: Vec<usize> = (0..case.conditions.len()).collect();
    conditions.retain(|index| *index == calibrated || case.is_measured(*index));
    conditions.sort_by_key(|index| *index != calibrated);
    let wanted = |condition| CompareRequest {
        condition,
        first: 0,
        individuals: vec![("recommended".to_owned(), case.start())],
        frames: if condition == calibrated { pictures } else { 0 },
        columns: Vec::new(),
    };
    conditions.into_iter().map(wanted).collect()
}

/// Simulates the recommended individual and returns its [`mismatches`]; returns none if it cannot be
/// simulated.
///
/// # Errors
/// If no job can be done, no evaluator is left, or the user stops it.
pub async fn check_records<E: Evaluator>(
    evaluator: &mut E,
    case: &Case,
    stop: &mut Stop,
) -> Result<Vec<String>, StudyError> {
    match compare(evaluator, case, &recommended(case, 0), stop).await {
        Ok(compared) => Ok(mismatches(case, &compared)),
        Err(StudyError::Unavailable { .. }) => Ok(Vec::new()),
        Err(error) => Err(error),
    }
}

/// Returns one sentence, with a remedy, for every measured record that correlates clearly better with its own
/// negated simulation or with that of another channel than with its own simulation.
pub fn mismatches(case: &Case, compared: &[Compared]) -> Vec<String> {
    let first = |one: &Compared| Some((one.condition, one.individuals.first()?.clone()));
    let simulated = compared.iter().filter_map(first);
    let said = simulated.flat_map(|(condition, curves)| of_condition(case, condition, &curves));
    said.collect()
}

fn of_condition(case: &Case, condition: usize, curves: &ComparedCurves) -> Vec<String> {
    if curves.drawn.verdict != Verdict::Complete {
        return Vec::new();
    }
    let channels = case.channels_of(condition).map(|(_, channel)| channel);
    let drawn: Vec<(&Channel, &[f64])> = channels
        .zip(curves.drawn.channels.iter().map(Vec::as_slice))
        .collect();
    let name = case.conditions.get(condition);
    let name = name.map_or("", |condition| condition.name.as_str());
    let own = drawn.iter().filter_map(|(channel, values)| {
        let record = &channel.record.as_ref()?.mean;
        let own = correlation(record, values)?;
        let others = drawn.iter().filter(|(other, _)| {
            other.name != channel.name
                && other.unit == channel.unit
                && other.abscissa == channel.abscissa
        });
        let others =
            others.filter_map(|(other, values)| Some((*other, correlation(record, values)?)));
        let other = others.max_by(|a, b| a.1.total_cmp(&b.1));
        let best = other.map_or(-own, |(_, other)| other.max(-own));
        if best < ALIKE || best - own < MARGIN {
            return None;
        }
        let title = &channel.title;
        Some(match other {
            Some((other, alike)) if alike > -own => format!(
                "{name}: the record of {title} correlates by {alike:.2} with the simulated {}, and by {own:.2} \
                 with its own: were two columns exchanged? correct their names",
                other.title
            ),
            _ => format!(
                "{name}: the record of {title} correlates by {own:.2} with its simulation: its sign is \
                 reversed; multiply the column by -1"
            ),
        })
    });
    own.collect()
}

/// Returns Pearson's correlation of two curves at the same points; none if the curves are constant, differ in
/// length, or have fewer than 8 points.
fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    if a.len() != b.len() || a.len() < 8 {
        return None;
    }
    let n = a.len() as f64;
    let (mean_a, mean_b) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let sums = a.iter().zip(b).fold([0.0; 3], |[ab, aa, bb], (a, b)| {
        let (a, b) = (a - mean_a, b - mean_b);
        [ab + a * b, aa + a * a, bb + b * b]
    });
    let [ab, aa, bb] = sums;
    let size = (aa * bb).sqrt();
    (size > 0.0 && size.is_finite()).then(|| ab / size)
}
