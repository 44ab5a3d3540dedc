//! Table and flags of the quantities of the machine by which a fit is judged.
use crate::data::{Calibration, ConditionResult};
use crate::document::{Block, Row, Section, Table};
use crate::kind;
use crate::machine_check::{ComparedChannel, MachineCheck};
use crate::number::{MISSING, fixed, percent, unit};
use protocol::case::Case;

/// Returns the quantities of the machine under every condition of a calibration.
pub fn checks(calibration: &Calibration) -> Vec<MachineCheck> {
    let results = calibration.conditions.iter();
    let checks = results.flat_map(|result| condition_checks(&calibration.case, result));
    checks.collect()
}

/// Returns the quantities of the machine under one condition, with the recommended and the optimised parameters.
pub fn condition_checks(case: &Case, result: &ConditionResult) -> Vec<MachineCheck> {
    let runs = [&result.recommended, &result.optimised];
    let [before, after] = runs.map(|run| run.shown(case, result.condition));
    let channels = case.channels_of(result.condition);
    let channels = channels.map(|(_, channel)| ComparedChannel {
        channel,
        measured: channel.record.as_ref().map_or(&[], |record| &record.mean),
        before: before.channel(channel),
        after: after.channel(channel),
    });
    let channels: Vec<ComparedChannel<'_>> = channels.collect();
    let curves = runs.map(|run| &run.curves);
    kind::of(case).checks(case, result.condition, &channels, Some(curves))
}

/// Builds the section of quantities with the recommended and the optimised parameters.
pub(crate) fn calibration(checks: &[MachineCheck]) -> Section {
    Section {
        id: "machine",
        title: "Stroke and torque",
        blocks: blocks(checks, ["recommended", "optimised"]),
    }
}

/// Builds the blocks of quantities: a warning with their flags, and the table; `heads` names its columns before and
/// after the fit. Empty if there are no quantities.
pub(crate) fn blocks(checks: &[MachineCheck], heads: [&str; 2]) -> Vec<Block> {
    let flags = flags(checks);
    let warning = (!flags.is_empty()).then_some(Block::Warning(flags));
    let table = table(checks, heads).map(Block::Table);
    warning.into_iter().chain(table).collect()
}

/// Builds the table of machine quantities; `heads` names the columns before and after the fit. `None` if there is
/// nothing to show.
pub(crate) fn table(checks: &[MachineCheck], heads: [&str; 2]) -> Option<Table> {
    if checks.is_empty() {
        return None;
    }
    let digits = |check: &MachineCheck| if check.unit == "m" { 3 } else { 1 };
    let mut rows = Vec::new();
    let mut condition = "";
    for check in checks {
        if check.condition != condition {
            condition = &check.condition;
            rows.push(Row::group(format!("Condition {condition}")));
        }
        let write = |value: Option<f64>| {
            value.map_or_else(|| MISSING.to_owned(), |value| fixed(value, digits(check)))
        };
        let off = check.measured.zip(check.after);
        let off = off.map_or_else(
            || MISSING.to_owned(),
            |(measured, after)| percent(after / measured - 1.0),
        );
        let mark = if check.flag.is_some() { " *" } else { "" };
        rows.push(Row::new(
            check.quantity,
            [
                unit(check.unit),
                write(check.measured),
                write(check.before),
                format!("{}{mark}", write(check.after)),
                off,
                write(check.limit),
            ],
        ));
    }
    let [before, after] = heads;
    let head = ["", "unit", "measured", before, after, "error", "limit"];
    let table = Table::new("Stroke and torque", head, rows);
    let flagged = checks.iter().any(|check| check.flag.is_some());
    let note = flagged.then(|| "* A reason not to trust the fit.".to_owned());
    Some(table.with_notes(note))
}

/// Returns the flags of all quantities, one sentence each.
pub fn flags(checks: &[MachineCheck]) -> Vec<String> {
    let flags = checks.iter().filter_map(|check| check.flag.clone());
    flags.collect()
}
