//! Whether a record can be that of its channel: a sensor of reversed sign, or two columns that were exchanged, give a
//! fit that is no fit, and nothing in its numbers says why.
use super::{
    compare::{Compared, Curves, Wanted, compare},
    error::StudyError,
    evaluator::Evaluator,
    stop::Stop,
};
use protocol::{
    case::{Case, Channel},
    job::Verdict,
};

/// By how much a record must correlate better with something else than with its own channel. Of 28 records of the
/// shipped and the practice cases each correlates by 0.97 at least with its own channel under the recommended values,
/// and by 0.86 at most with any other, with either sign, but for two channels that mirror each other.
const MARGIN: f64 = 0.2;

/// The correlation from which that something else is what was recorded.
const ALIKE: f64 = 0.8;

/// What is wanted to look at the recommended individual under every condition with a record, the calibrated one
/// first and with so many pictures of what moves.
pub fn recommended(case: &Case, pictures: u32) -> Vec<Wanted> {
    let calibrated = case.objective.condition;
    let mut conditions: Vec<usize> = (0..case.conditions.len()).collect();
    conditions.retain(|index| *index == calibrated || case.is_measured(*index));
    conditions.sort_by_key(|index| *index != calibrated);
    let wanted = |condition| Wanted {
        condition,
        first: 0,
        individuals: vec![("recommended".to_owned(), case.start())],
        pictures: if condition == calibrated { pictures } else { 0 },
        columns: Vec::new(),
    };
    conditions.into_iter().map(wanted).collect()
}

/// Simulates the recommended individual and says what [`mismatches`] does; nothing where it cannot be simulated.
///
/// # Errors
/// If no job can be done, nobody evaluates any more, or the user stops it.
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

/// Says of every record that correlates clearly better with minus its own simulation, or with another channel's, which
/// it is and what to do; one sentence each.
pub fn mismatches(case: &Case, compared: &[Compared]) -> Vec<String> {
    let first = |one: &Compared| Some((one.condition, one.individuals.first()?.clone()));
    let simulated = compared.iter().filter_map(first);
    let said = simulated.flat_map(|(condition, curves)| of_condition(case, condition, &curves));
    said.collect()
}

fn of_condition(case: &Case, condition: usize, curves: &Curves) -> Vec<String> {
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

/// Pearson's correlation of two curves of the same points; none of curves that do not vary or differ in length.
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
