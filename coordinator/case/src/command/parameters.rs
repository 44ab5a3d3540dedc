//! Export of a case's unknowns as a PEST parameter file, and of the derivatives by them as a Jacobian matrix file.
use exchange::pest::{self, ParRow};
use protocol::{
    case::{Case, Unknown},
    external::{ChannelSource, External},
};
use record::Curves;

/// Returns the text of a PEST parameter file with the given values of the unknowns.
pub(super) fn parameters(case: &Case, genes: &[f64]) -> String {
    let external = External::of(&case.model).ok();
    let written = external.map(|own| own.parameters).unwrap_or_default();
    let row = |(at, (unknown, value)): (usize, (&Unknown, &f64))| ParRow {
        name: unknown.name.clone(),
        value: *value,
        scale: written.get(at).map_or(1.0, |own| own.factor),
        offset: written.get(at).map_or(0.0, |own| own.offset),
    };
    let rows: Vec<ParRow> = case
        .unknowns
        .iter()
        .zip(genes)
        .enumerate()
        .map(row)
        .collect();
    pest::par(&rows)
}

/// Returns the name and content of PEST's Jacobian matrix file: derivatives of the measured observations by the estimated
/// parameters, by the decimal logarithm of logarithmic ones. `None` if a channel is not a list of named values with an
/// absolute zero, of which every value has an exact derivative.
pub(super) fn jacobian(
    case: &Case,
    unknowns: &[&str],
    channels: &[usize],
    derivatives: &[Curves],
) -> Option<(&'static str, Vec<u8>)> {
    let external = External::of(&case.model).ok()?;
    let of_condition: Vec<usize> = case
        .channels_of(case.objective.condition)
        .map(|(at, _)| at)
        .collect();
    let mut observations = Vec::new();
    for own in channels {
        let at = *of_condition.get(*own)?;
        let ChannelSource::Named(names) = external.curves.get(at)? else {
            return None;
        };
        if !case.channels.get(at)?.is_absolute() {
            return None;
        }
        observations.extend(names.iter().cloned());
    }
    let parameters: Vec<String> = unknowns.iter().map(|name| (*name).to_owned()).collect();
    let columns: Vec<Vec<f64>> = derivatives.iter().map(|by| by.concat()).collect();
    let is_whole = columns.iter().all(|by| by.len() == observations.len());
    is_whole.then(|| pest::jacobian(&parameters, &observations, &columns))
}
