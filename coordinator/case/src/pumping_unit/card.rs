//! Reading of load cards: load at the suspension over one crank turn, equally spaced and periodic.
use crate::{
    error::{CaseError, contradiction},
    file,
    table::CsvTable,
};
use protocol::pumping_unit::{LoadCard, Smoothing};
use std::path::Path;

/// Reads and checks the columns `turn_deg, polished_rod_load_n` \[deg, N\]; `role` describes the file in
/// messages.
///
/// # Errors
/// Returns an error if the angles do not start at 0, are unevenly spaced or include 360, if the loads are not
/// in newtons judging by their magnitude, or if the last and first rows differ by a jump.
pub fn read(path: &Path, smoothing: Smoothing, role: &str) -> Result<LoadCard, CaseError> {
    let [turn_deg, load_n] = of(path, &file::read(path, role)?)?;
    Ok(LoadCard {
        turn_deg,
        load_n,
        smoothing,
    })
}

/// Reads and checks the angles and loads of a card from its bytes.
///
/// # Errors
/// As [`read`], but for a missing file.
pub(super) fn of(path: &Path, bytes: &[u8]) -> Result<[Vec<f64>; 2], CaseError> {
    let mut table = CsvTable::read(path, bytes, &["turn_deg", "polished_rod_load_n"])?;
    check_turn(path, &table)?;
    check_load(path, &table)?;
    let load_n = table.columns.pop().unwrap_or_default();
    let turn_deg = table.columns.pop().unwrap_or_default();
    Ok([turn_deg, load_n])
}

/// Checks that the angles run from 0 in equal steps to one step before 360.
fn check_turn(path: &Path, table: &CsvTable) -> Result<(), CaseError> {
    const HELP: &str = "give the load on equally spaced crank angles 0, step, .. 360 - step, \
                        counted from bottom dead centre";
    let Some([turn, _]) = table.columns.first_chunk::<2>() else {
        return Ok(());
    };
    let count = turn.len();
    if count < 24 {
        return Err(contradiction(
            path,
            "the number of rows",
            count.to_string(),
            "a load card needs at least 24 (15 deg)",
            HELP,
        ));
    }
    if let (Some(last), true) = (turn.last(), turn.len() > 24)
        && (last - 360.0).abs() < 1e-6
    {
        return Err(table.cell(
            path,
            (count - 1, 0),
            last.to_string(),
            "angles below 360 deg",
            "remove the last row: it repeats the first one",
        ));
    }
    let step = 360.0 / count as f64;
    for (row, angle) in turn.iter().enumerate() {
        let expected = row as f64 * step;
        // angles are often written with one or two decimals
        if (angle - expected).abs() > 0.02_f64.max(0.02 * step) {
            return Err(table.cell(
                path,
                (row, 0),
                angle.to_string(),
                format!(
                    "{expected:.4} deg (row {} of {count} equal steps of a turn)",
                    row + 1
                ),
                HELP,
            ));
        }
    }
    Ok(())
}

/// Checks that the loads have the magnitude of newtons, are not negative and are periodic.
fn check_load(path: &Path, table: &CsvTable) -> Result<(), CaseError> {
    let Some([_, load]) = table.columns.first_chunk::<2>() else {
        return Ok(());
    };
    let mut peak = (0, 0.0_f64);
    for (row, &value) in load.iter().enumerate() {
        if value < 0.0 {
            return Err(table.cell(
                path,
                (row, 1),
                value.to_string(),
                "0 to 1e6 N, positive downwards",
                "a rope cannot push: check the sign and the zero of the load cell",
            ));
        }
        if value > peak.1 {
            peak = (row, value);
        }
    }
    if !(1.0e3..=1.0e6).contains(&peak.1) {
        let help = if peak.1 < 1.0e3 {
            "the largest load is that small: the card looks like kN; multiply by 1000"
        } else {
            "the largest load is that great: the card does not look like newtons"
        };
        return Err(table.cell(
            path,
            (peak.0, 1),
            peak.1.to_string(),
            "a largest load of 1e3 to 1e6 N",
            help,
        ));
    }
    let steps = load
        .iter()
        .zip(load.iter().skip(1))
        .map(|(a, b)| (b - a).abs());
    let largest = steps.fold(0.0, f64::max);
    let lowest = load.iter().copied().fold(f64::INFINITY, f64::min);
    let (first, last) = (
        load.first().copied().unwrap_or_default(),
        load.last().copied().unwrap_or_default(),
    );
    let allowed = 2.0 * largest + 0.02 * (peak.1 - lowest);
    if (first - last).abs() > allowed {
        return Err(table.cell(
            path,
            (load.len() - 1, 1),
            last.to_string(),
            format!("within {allowed:.0} N of the first row's {first} N: a card is periodic"),
            "close the card: give one whole turn, without drift between its ends",
        ));
    }
    Ok(())
}
