//! Report on the parallel scaling of searches: measured results and their figure. Takes these data as plain values and
//! does not measure.
use super::chart::speed_up;
use super::data::Origin;
use super::document::{Block, Report, Row as Cells, Section, Table};
use super::folder::{ReportError, write_report};
use super::number::{MISSING, count, duration, fixed, percent, significant};
use super::section::origin;
use protocol::case::Case;
use std::path::{Path, PathBuf};
use study::scaling::{ScalingResult, ScalingRow, SlotMode};

/// Index of the median among quantiles in steps of 5 %.
const MEDIAN: usize = 10;

/// Input data of a scaling report.
pub struct ScalingInput<'a> {
    /// Case on which the searches ran.
    pub case: &'a Case,
    /// Measured scaling of the searches.
    pub scaled: &'a ScalingResult,
    /// Provenance of the measurement (run, program, digest).
    pub origin: Origin,
}

/// Builds the report on scaling.
pub fn report(subject: &ScalingInput<'_>) -> Report {
    let title = format!("How searches on {} scale", subject.case.name);
    let facts = origin::facts(&subject.origin, subject.case);
    let sections = vec![
        rows(subject.scaled),
        origin::section(vec![Block::Facts(facts)]),
    ];
    Report::new(title, &subject.origin.run, sections)
}

/// Writes the scaling report into a folder: `report.html`, `tables.txt` and `figures/*.svg`. Returns the
/// paths, the HTML first.
///
/// # Errors
/// [`ReportError`] when a file cannot be written.
pub fn write(folder: &Path, subject: &ScalingInput<'_>) -> Result<Vec<PathBuf>, ReportError> {
    write_report(folder, &report(subject))
}

fn rows(scaled: &ScalingResult) -> Section {
    Section {
        id: "scaling",
        title: "Speed-up and slot time",
        blocks: vec![
            Block::Table(speeds(scaled)),
            Block::Figure(speed_up(&scaled.rows)),
            Block::Table(shares(scaled)),
            Block::Table(simulations(scaled)),
        ],
    }
}

/// Builds the rows of a scaling table, grouped by workers: those of this machine and remote ones.
fn grouped(scaled: &ScalingResult, cells: impl Fn(&ScalingRow) -> Vec<String>) -> Vec<Cells> {
    let groups = [
        (SlotMode::Computed, "computed: the case, on this machine"),
        (SlotMode::Remote, "remote: the case, on other workers"),
    ];
    let mut rows = Vec::new();
    for (how, title) in groups {
        let of = scaled.rows.iter().filter(|row| row.how == how);
        let own =
            of.map(|row| Cells::new(row.search(), [vec![count(row.slots)], cells(row)].concat()));
        let own: Vec<Cells> = own.collect();
        if !own.is_empty() {
            rows.push(Cells::group(title));
            rows.extend(own);
        }
    }
    rows
}

fn speeds(scaled: &ScalingResult) -> Table {
    let cells = |row: &ScalingRow| {
        vec![
            count(row.evaluations),
            duration(row.wall_s),
            significant(row.speed_up),
            fixed(row.efficiency, 3),
            fixed(row.coordinator_us_per_result, 0),
            percent(row.coordinator_share),
        ]
    };
    let head = [
        "search and population",
        "slots",
        "evaluations",
        "wall time",
        "speed-up",
        "efficiency",
        "coordinator (us a result)",
        "coordinator's share",
    ];
    Table::new("Speed-up", head, grouped(scaled, cells)).with_notes([
        "Speed-up is what one slot alone computes for as many evaluations, over the wall time; efficiency is that \
         over the slots. The coordinator's share is its processor time over the wall time.",
    ])
}

fn shares(scaled: &ScalingResult) -> Table {
    let cells = |row: &ScalingRow| {
        let shares = row.shares;
        let all = [
            shares.useful,
            shares.barrier,
            shares.starved,
            shares.speculative,
            shares.failed + shares.lost,
        ];
        all.into_iter().map(percent).collect()
    };
    let head = [
        "search and population",
        "slots",
        "useful",
        "barrier",
        "starved",
        "speculative",
        "failed or lost",
    ];
    Table::new("Where slot time went", head, grouped(scaled, cells)).with_notes([
        "Barrier: slots waited for results that others computed. Starved: they waited for the next order. \
         Speculative: they computed what another slot brought first, or what the search might have requested \
         next and did not.",
    ])
}

fn simulations(scaled: &ScalingResult) -> Table {
    let quantile = |row: &ScalingRow, index: usize| {
        let at = row.simulation_quantiles_s.get(index);
        at.map_or_else(|| MISSING.to_owned(), |time| significant(*time))
    };
    let cells = |row: &ScalingRow| {
        vec![
            significant(row.simulation_s),
            quantile(row, MEDIAN),
            quantile(row, MEDIAN + 9),
            fixed(row.derivatives_over_plain, 1),
        ]
    };
    let head = [
        "search and population",
        "slots",
        "mean [s]",
        "median [s]",
        "95 % at most [s]",
        "derivatives",
    ];
    Table::new("Computing times of simulations", head, grouped(scaled, cells)).with_notes([
        "Derivatives: computing time of a simulation with the derivatives by all unknowns, over that of a plain one.",
    ])
}
