//! Table of parameters that would have to vary along a record or between conditions.
use crate::diagnosis::subject::Subject;
use crate::document::{Row, Table};
use crate::number::{figure, fixed, percent};
use crate::words::condition_name;
use discrepancy::model::Fit;
use discrepancy::place::wander::{Part, Shift, Wander};

/// Significance level: a shift with a larger p-value is taken as noise.
const CLEAR: f64 = 0.05;
/// Maximum number of parameters shown.
const SHOWN: usize = 6;

/// Variation of the parameters from part to part, under one fitted model.
pub(in crate::diagnosis) struct Wandering<'a> {
    /// Title of the table.
    pub title: &'static str,
    /// Fitted model.
    pub fit: &'a Fit,
    /// How far each unknown would have to change from part to part.
    pub wander: &'a [Wander],
}

/// Builds the table of the unknowns that would have to vary under a model, with their value in each part;
/// `None` if there are none.
pub(in crate::diagnosis) fn wander(
    subject: &Subject<'_>,
    Wandering { title, fit, wander }: &Wandering<'_>,
) -> Option<Table> {
    let clear: Vec<&Wander> = clear(fit, wander).collect();
    let first = clear.first()?;
    let channels = subject.calibrated().map(|record| &record.channels);
    let axis_unit = channels.and_then(|all| Some(all.first()?.channel.abscissa.unit.as_str()));
    let axis_unit = axis_unit.unwrap_or_default();
    let at = |place| match axis_unit {
        "deg" => fixed(place, 0),
        _ => figure(place),
    };
    let part = |shift: &Shift| match shift.part {
        Part::Sector { from, to } => {
            format!("{} to {} {axis_unit}", at(from), at(to))
        }
        Part::Condition(index) => condition_name(subject.case, index),
    };
    let parts = first.shifts.iter().map(part);
    let head = [String::new(), "whole record".to_owned()].into_iter();
    let head = head.chain(parts).chain(["takes up".to_owned()]);
    let rows = clear.iter().take(SHOWN).filter_map(|wander| {
        let k = wander.unknown;
        let axis = fit.model.space.axes().get(k)?;
        let value = |by: f64| figure(axis.value(fit.x()[k] + by));
        let moved = |shift: &Shift| {
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
    Some(table.noted([
        "Each refitted alone, linearly, all others held; values in brackets lie within the scatter \
         between cycles. The last column is the share of what is left along the record that it would take \
         up.",
    ]))
}

/// Returns the unknowns of the case with a significant shift in at least one part.
fn clear<'a>(fit: &Fit, wander: &'a [Wander]) -> impl Iterator<Item = &'a Wander> {
    let genes = fit.model.space.dimension();
    wander.iter().filter(move |wander| {
        wander.unknown < genes && wander.shifts.iter().any(|shift| shift.p_value <= CLEAR)
    })
}
