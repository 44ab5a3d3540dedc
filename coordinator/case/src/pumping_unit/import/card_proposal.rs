//! Proposal of the mapping of a dynamometer's card.
use super::{
    card::is_theta,
    logger::{self, Columns, Layout, Sample},
    proposal::{Known, MappingProposal, heading},
    role::{Role, place, quoted, role},
};
use crate::error::CaseError;
use std::{fmt::Write as _, path::Path};

/// Line with the order of a card's points.
const ORDER: &str =
    "order = \"forward\"                    # or \"reversed\": from the last point to the first\n";

/// Proposes the mapping of a dynamometer's card.
///
/// # Errors
/// Returns an error for a file without a table, and cells that are no numbers.
pub(super) fn propose(
    path: &Path,
    file: &str,
    known: &Known,
) -> Result<MappingProposal, CaseError> {
    let stroke_m = known.rod_position_m.iter().copied().fold(0.0, f64::max);
    let mut text = String::new();
    let mut open = Vec::new();
    let files = [file.to_owned()];
    if is_theta_file(path)? {
        heading(&mut text, known, &files, None);
        text.push_str("\n[card]                               # Theta's format: inch and lbf\n");
        text.push_str(ORDER);
        return Ok(MappingProposal { text, open });
    }
    let sample = Sample::read(path)?;
    let layout = logger::sniff(path, &sample)?;
    let columns = Columns::read(path, &layout)?;
    heading(&mut text, known, &files, Some(&layout));
    text.push_str("\n[card]\n");
    let roles: Vec<Option<Role>> = columns
        .names
        .iter()
        .zip(&columns.units)
        .map(|(name, unit)| role(name, unit.as_deref()))
        .collect();
    let bare = layout.header_line.is_none() && columns.names.len() == 2;
    let bare = |at: usize| Ok(bare.then_some(at));
    for (key, role, only) in [
        ("position", Role::Position, bare(0)),
        ("load", Role::Load, bare(1)),
    ] {
        let found = match place(&columns, &roles, role) {
            Ok(None) => only,
            found => found,
        };
        let Ok(Some(place)) = found else {
            let _infallible = writeln!(text, "# {key} = {{ column = \"..\", unit = \"..\" }}");
            open.push(match found {
                Err(names) => format!("card.{key}: which of the columns {names}"),
                Ok(_) => format!("card.{key}: its column and unit"),
            });
            continue;
        };
        let name = &columns.names[place];
        let unit = columns.units[place].clone();
        let unit = match unit {
            None if key == "position" => fitting_unit(path, &layout, name, stroke_m)?,
            unit => unit.map(|unit| (unit, "")),
        };
        let column = quoted(name);
        if let Some((unit, remark)) = unit {
            let unit = quoted(&unit);
            let _infallible = writeln!(
                text,
                "{key} = {{ column = {column}, unit = {unit} }}{remark}"
            );
        } else {
            let _infallible = writeln!(text, "# {key} = {{ column = {column}, unit = \"lbf\" }}");
            open.push(format!(
                "card.{key}: the unit of column {column} (lbf, kN, kgf, N)"
            ));
        }
    }
    text.push_str(ORDER);
    text.push_str(
        "# strokes_per_minute = 5.0           # of the card, compared with the condition's\n",
    );
    Ok(MappingProposal { text, open })
}

/// Returns the unit of length in which the range of a column is the stroke of the case, with a remark.
fn fitting_unit(
    path: &Path,
    layout: &Layout,
    column: &str,
    stroke_m: f64,
) -> Result<Option<(String, &'static str)>, CaseError> {
    let table = logger::survey(path, layout, &[column])?;
    let values = table
        .columns
        .iter()
        .flatten()
        .filter(|value| !value.is_nan());
    let lowest = values.clone().copied().fold(f64::INFINITY, f64::min);
    let highest = values.copied().fold(f64::NEG_INFINITY, f64::max);
    let fits = |unit: &&&str| {
        let size = logger::factor(unit, "m").unwrap_or(f64::NAN);
        ((highest - lowest) * size / stroke_m - 1.0).abs() < 0.2
    };
    let unit = ["m", "mm", "cm", "in", "ft"].iter().find(fits).copied();
    Ok(unit.map(|unit| (unit.to_owned(), "   # by the stroke of the case")))
}

/// Longest table that is taken for a card if it has an angle too \[lines\]: a card has some hundred points.
const LONGEST: u64 = 1500;

/// Returns whether a file is a load card: in Theta's format, or a table with a load and no gauge.
pub(super) fn is_card(path: &Path) -> Result<bool, CaseError> {
    if is_theta_file(path)? {
        return Ok(true);
    }
    let sample = Sample::read(path)?;
    let layout = logger::sniff(path, &sample)?;
    let columns = Columns::read(path, &layout)?;
    let short = sample.lines <= LONGEST;
    if layout.header_line.is_none() && columns.names.len() == 2 {
        return Ok(short);
    }
    let roles = columns.names.iter().zip(&columns.units);
    let roles: Vec<Role> = roles
        .filter_map(|(name, unit)| role(name, unit.as_deref()))
        .collect();
    let gauge = roles.iter().any(|role| matches!(role, Role::Gauge(_)));
    Ok(!gauge && short && roles.contains(&Role::Load) && roles.contains(&Role::Position))
}

/// Returns whether the first lines of a file are those of Theta's format.
fn is_theta_file(path: &Path) -> Result<bool, CaseError> {
    let sample = Sample::read(path)?;
    let lines = sample
        .head
        .iter()
        .map(|(_, line)| String::from_utf8_lossy(line));
    Ok(is_theta(&lines.take(4).collect::<Vec<_>>().join("\n")))
}
