//! Table of the parameters that would have to vary along a record or between conditions for the model to fit.
use crate::diagnosis::subject::DiagnosisInput;
use crate::document::{Row, Table};
use crate::number::{fixed, percent, significant};
use crate::words::condition_name;
use discrepancy::localisation::parameter_drift::{ParameterDrift, ParameterShift, RecordPart};
use discrepancy::model::FitSummary;
use search::space::Space;

/// Significance level: a shift of a parameter with a larger p-value is taken as noise.
const CLEAR: f64 = 0.05;
/// Maximum number of parameters shown.
const SHOWN: usize = 6;

/// Input of the table of a fitted model's parameters that would have to vary from sector to sector of the
/// record or between conditions.
pub(in crate::diagnosis) struct VariationUnderModel<'a> {
    /// Title of the table.
    pub title: &'static str,
    /// Fitted model whose parameters are examined.
    pub fit: &'a FitSummary,
    /// Change that each unknown would need in each sector of the record or under each condition.
    pub wander: &'a [ParameterDrift],
}

/// Builds the table of the unknowns that would have to vary under a fitted model, with their value in each
/// sector of the record or under each condition; `None` if there are none.
pub(in crate::diagnosis) fn wander(
    subject: &DiagnosisInput<'_>,
    VariationUnderModel { title, fit, wander }: &VariationUnderModel<'_>,
) -> Option<Table> {
    let clear: Vec<&ParameterDrift> = clear(fit, wander).collect();
    let first = clear.first()?;
    let channels = subject.calibrated().map(|record| &record.channels);
    let axis_unit = channels.and_then(|all| Some(all.first()?.channel.abscissa.unit.as_str()));
    let axis_unit = axis_unit.unwrap_or_default();
    let at = |place| match axis_unit {
        "deg" => fixed(place, 0),
        _ => significant(place),
    };
    let part = |shift: &ParameterShift| match shift.part {
        RecordPart::Sector { from, to } => {
            format!("{} to {} {axis_unit}", at(from), at(to))
        }
        RecordPart::Condition(index) => condition_name(subject.case, index),
    };
    let parts = first.shifts.iter().map(part);
    let head = [String::new(), "whole record".to_owned()].into_iter();
    let head = head.chain(parts).chain(["takes up".to_owned()]);
    let space = Space::new(&subject.case.unknowns).ok()?;
    let rows = clear.iter().take(SHOWN).filter_map(|wander| {
        let k = wander.unknown;
        let (axis, at) = space.axes().get(k).zip(fit.coordinates.get(k))?;
        let value = |by: f64| significant(axis.value(at + by));
        let moved = |shift: &ParameterShift| {
            if shift.p_value <= CLEAR {
                value(shift.by)
            } else {
                format!("({})", value(shift.by))
            }
        };
        let mut cells = vec![value(0.0)];
        cells.extend(wander.shifts.iter().map(moved));
        cells.push(percent(wander.explained));
        Some(Row::of(&axis.unknown, cells))
    });
    let table = Table {
        head: head.collect(),
        ..Table::new(*title, [], rows.collect())
    };
    Some(table.with_notes([
        "Each refitted alone, linearly, all others held; values in brackets lie within the scatter \
         between cycles. The last column is the share of what is left along the record that it would take \
         up.",
    ]))
}

/// Returns the unknowns of the case whose shift is significant in at least one sector or condition of the
/// records.
fn clear<'a>(
    fit: &FitSummary,
    wander: &'a [ParameterDrift],
) -> impl Iterator<Item = &'a ParameterDrift> {
    let genes = fit.coordinates.len();
    wander.iter().filter(move |wander| {
        wander.unknown < genes && wander.shifts.iter().any(|shift| shift.p_value <= CLEAR)
    })
}
