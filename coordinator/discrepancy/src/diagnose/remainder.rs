//! Completeness of an answer: the share of the gap that it explains, where more than noise is left, and
//! whether its fit is one at all.
use crate::baseline::session::Session;
use crate::estimate::discrepancy::{DiscrepancyEstimate, discrepancy};
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::model::nuisance_parameter::NuisanceParameter;
use crate::thresholds::{AT_BOUND, BEYOND, MAX_PREDICTED_DECREASE, WITHIN};
use crate::validation::compare::{DataRole, GapRow, ValidationRecord};
use crate::validation::predictive::is_explained;
use serde::{Deserialize, Serialize};

/// What an answer explains of the disagreement between simulation and measurement, and what it leaves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Remainder {
    /// Share of the gap of the fitted record that the answer closes; `None` without an answer.
    pub explained: Option<f64>,
    /// Smooth discrepancy that the model of the answer still needs; `None` where it needs none.
    pub discrepancy: Option<DiscrepancyEstimate>,
    /// Records, fitted or not, on which the model of the answer leaves more than noise.
    pub left: Vec<Left>,
    /// Whether the fit of the answer has converged.
    pub is_converged: bool,
    /// Unknowns, instruments and effect parameters of the answer that stand at a bound, and instruments
    /// beyond three times their tolerance.
    pub at_bounds: Vec<String>,
    /// Instruments that the answer would need far beyond their tolerance if they were not held within it, which
    /// indicates that something else is missing.
    pub beyond: Vec<String>,
}

/// Record on which a model leaves more than noise, with the place where most of it lies.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Left {
    /// Index of the record's working condition in the case.
    pub condition: usize,
    /// Role of the record: fitted, or which kind of held-out data it is.
    pub part: DataRole,
    /// Share of the record's gap without effects that the answer leaves, 1 without an answer.
    pub share: f64,
    /// Title of the channel with the largest residual relative to its measured variance.
    pub channel: String,
    /// Shortest range of that channel's abscissa with half of its squared residual; the second end lies
    /// before the first where the range contains the end of a period.
    pub between: [f64; 2],
    /// Unit of the abscissa.
    pub unit: String,
}

impl Left {
    /// Describes in words how much is left, and where.
    ///
    /// `condition` is the description of its condition.
    pub(crate) fn words(&self, condition: &str) -> String {
        let [from, to] = self.between;
        let on = self.part.words(condition);
        let how_much = if self.share > 1.0 {
            format!("the gap to {on} grows by {}", percent(self.share - 1.0))
        } else if self.part == DataRole::Fitted {
            format!("{} remain", percent(self.share))
        } else {
            format!("{} of the gap to {on} remain", percent(self.share))
        };
        let at = format!(
            "{} between {from:.0} and {to:.0} {}",
            self.channel, self.unit
        );
        format!("{how_much}, most of it at {at}")
    }
}

/// Formats a share in per cent, with a digit more near its ends.
pub(crate) fn percent(share: f64) -> String {
    let value = 100.0 * share;
    if (1.0..=99.0).contains(&value.abs()) || value.abs() < 0.05 || value.abs() > 99.95 {
        format!("{value:.0} %")
    } else {
        format!("{value:.1} %")
    }
}

/// Determines what a model leaves: `rows` are the gaps with and without its effects, by record.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn remainder<L: Laboratory>(
    session: &mut Session<'_, L>,
    fit: &Fit,
    shown: &[ValidationRecord<'_>],
    rows: &[GapRow],
) -> Result<Remainder, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let level = inputs.thresholds.adequacy;
    let answered = !fit.model.added.is_empty();
    let mut left = Vec::new();
    for one in shown {
        let explained = if one.part == DataRole::Fitted {
            // a stated noise that is too high leaves less than noise
            let less = !base.known().is_seen() && fit.chi_squared() < base.noise();
            Some(less || base.explains(fit, level))
        } else {
            let mut experiments = session.experiments(Stage::Show);
            is_explained(&mut experiments, one, fit, level).await?
        };
        let of = |row: &&GapRow| row.part == one.part && row.condition == one.record.condition;
        if explained == Some(false)
            && let Some(row) = rows.iter().find(of)
        {
            let share = if answered {
                1.0 - row.closed.closed
            } else {
                1.0
            };
            left.extend(place(one, &row.after, share));
        }
    }
    let fitted = rows.iter().find(|row| row.part == DataRole::Fitted);
    Ok(Remainder {
        explained: fitted.filter(|_| answered).map(|row| row.closed.closed),
        discrepancy: fitted.and_then(|row| discrepancy(&base.record, fit, row.closed.before)),
        left,
        is_converged: is_converged(fit),
        at_bounds: at_bounds(inputs, fit),
        beyond: Vec::new(),
    })
}

/// Returns whether one more step is predicted to lower the misfit of a fit by no more than a converged fit
/// may promise.
pub(crate) fn is_converged(fit: &Fit) -> bool {
    fit.search.predicted_decrease() <= MAX_PREDICTED_DECREASE
}

/// Lists the instruments of a fit whose error lies far beyond their tolerance.
pub(crate) fn instruments_beyond(fit: &Fit) -> Vec<String> {
    let values = fit.model.nuisance_values(fit.x());
    values
        .filter(|(_, x)| x.abs() > BEYOND)
        .map(|(one, x)| instrument(one, x))
        .collect()
}

fn instrument(one: &NuisanceParameter, x: f64) -> String {
    let own = &one.nuisance;
    format!("{}.{} at {:.1} tolerances", own.id, own.parameter, x)
}

/// Lists the unknowns, instruments and effect parameters of a fit that stand at a bound.
fn at_bounds(inputs: &Inputs, fit: &Fit) -> Vec<String> {
    let axes = inputs
        .space
        .axes()
        .iter()
        .map(|axis| axis.unknown.name.clone());
    let nuisances = fit
        .model
        .nuisance_values(fit.x())
        .map(|(one, x)| instrument(one, x));
    let effects = fit.model.added.iter();
    let effects = effects.flat_map(|own| {
        own.parameters
            .iter()
            .map(|p| format!("{}.{}", own.id, p.name))
    });
    let names = axes.chain(nuisances).chain(effects);
    let first = inputs.space.dimension();
    let instruments = first..first + fit.model.active_nuisances().count();
    let each = names.zip(fit.x().iter().zip(fit.variables())).enumerate();
    each.filter(|(k, (_, (x, v)))| {
        if instruments.contains(k) {
            return x.abs() >= WITHIN;
        }
        let near = AT_BOUND * (v.upper - v.lower);
        // an effect may well vanish: at zero a parameter stands at no limit of its own
        let at = |bound: f64| (**x - bound).abs() <= near && (*k < first || bound != 0.0);
        at(v.lower) || at(v.upper)
    })
    .map(|(_, (name, _))| name)
    .collect()
}

/// Locates the residual of simulated curves on a record: the channel with the largest residual relative to its
/// variance, and the shortest range with half of it.
fn place(one: &ValidationRecord<'_>, simulated: &[Vec<f64>], share: f64) -> Option<Left> {
    let record = one.record;
    let mean = record.mean();
    let residual = |c: usize| -> Vec<f64> {
        let own = &record.channels[c].channel;
        let left: Vec<f64> = mean[c]
            .iter()
            .zip(&simulated[c])
            .map(|(y, s)| y - s)
            .collect();
        let offset = if own.is_absolute() {
            0.0
        } else {
            average(&left)
        };
        left.into_iter()
            .map(|r| (r - offset) * (r - offset))
            .collect()
    };
    let relative = |c: &usize| {
        let own = average(&mean[*c]);
        let variance = mean[*c].iter().map(|y| (y - own) * (y - own)).sum::<f64>();
        residual(*c).iter().sum::<f64>() / variance.max(f64::MIN_POSITIVE)
    };
    let scored = record.scored();
    let c = scored
        .iter()
        .max_by(|a, b| relative(a).total_cmp(&relative(b)))?;
    let own = &record.channels[*c].channel;
    let periodic = own.abscissa.period.is_some();
    let [from, to] = shortest_half(&residual(*c), periodic)?;
    Some(Left {
        condition: record.condition,
        part: one.part,
        share,
        channel: own.title.clone(),
        between: [own.abscissa.points[from], own.abscissa.points[to]],
        unit: own.abscissa.unit.clone(),
    })
}

fn average(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Returns the first and last index of the shortest range of values that holds half of their sum; on a circle
/// the last may lie before the first. `None` where there is no value.
fn shortest_half(values: &[f64], circle: bool) -> Option<[usize; 2]> {
    let n = values.len();
    let half = 0.5 * values.iter().sum::<f64>();
    let mut best: Option<(usize, usize)> = None;
    let (mut sum, mut length) = (0.0, 0);
    for from in 0..n {
        while sum < half && length < n && (circle || from + length < n) {
            sum += values[(from + length) % n];
            length += 1;
        }
        if sum >= half && best.is_none_or(|(_, least)| length < least) {
            best = Some((from, length.max(1)));
        }
        if length > 0 {
            sum -= values[from];
            length -= 1;
        }
    }
    best.map(|(from, length)| [from, (from + length - 1) % n])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shortest_half_is_where_the_residual_is() {
        let mut values = vec![0.1; 36];
        values[20..26].fill(5.0);
        assert_eq!(shortest_half(&values, true), Some([20, 23]));
        // across the end of the turn, and not across the end of a log
        let mut values = vec![0.0; 36];
        values[35] = 3.0;
        values[0] = 3.0;
        values[17] = 3.5;
        values[18] = 0.5;
        assert_eq!(shortest_half(&values, true), Some([35, 0]));
        assert_eq!(shortest_half(&values, false), Some([0, 17]));
        assert_eq!(shortest_half(&[], true), None);
    }
}
