//! Parameters that would have to wander along a record or from condition to condition.
use crate::diagnosis::subject::Subject;
use crate::document::{Row, Table};
use crate::number::{figure, fixed, percent};
use crate::words::condition_name;
use discrepancy::model::Fit;
use discrepancy::place::wander::{Part, Shift, Wander};

/// Probability below which a shift is no noise.
const CLEAR: f64 = 0.05;
/// Parameters that are shown.
const SHOWN: usize = 6;

/// Wandering parameters under a fitted model.
pub(in crate::diagnosis) struct Wandering<'a> {
    /// What the table is headed with.
    pub title: &'static str,
    /// The model.
    pub fit: &'a Fit,
    /// How far each unknown would have to change from part to part.
    pub wander: &'a [Wander],
}

/// The unknowns that would have to wander under a model, with the values that they would take.
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

/// Unknowns of which some part stands out of the noise.
fn clear<'a>(fit: &Fit, wander: &'a [Wander]) -> impl Iterator<Item = &'a Wander> {
    let genes = fit.model.space.dimension();
    wander.iter().filter(move |wander| {
        wander.unknown < genes && wander.shifts.iter().any(|shift| shift.p_value <= CLEAR)
    })
}
