//! Command line program `rejudge`: table of false and right names on a linearised case.
use anyhow::Context as _;
use case::Overrides;
use clap::Parser;
use discrepancy::thresholds::Thresholds;
use rejudge::LinearModel;
use rejudge::trial::{Rig, rows};
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use worker::SIMULATORS;

/// Repeats the decisions of a diagnosis on synthetic records of a linearised case, without a simulation.
#[derive(Debug, Parser)]
struct Cli {
    /// Case folder.
    #[arg(long)]
    case: PathBuf,
    /// File of the linearised case; made by some dozens of simulations if it does not exist.
    #[arg(long)]
    table: PathBuf,
    /// Number of records in each row of the table.
    #[arg(long, default_value_t = 20)]
    sets: u64,
    /// Size of the hidden effects, in detection limits.
    #[arg(long, default_value_t = 3.0)]
    times: f64,
    /// Print a line for each record that got a wrong name, or none although an effect is hidden.
    #[arg(long)]
    lines: bool,
}

fn main() -> anyhow::Result<()> {
    let cli = Cli::parse();
    let loaded = case::load_with_notes(&cli.case, &Overrides::default())?;
    let case = loaded.case;
    let thresholds = Thresholds::default();
    let (usual, finer) =
        case::kind::of(&case).diagnosis_numerics(&case, thresholds.step, thresholds.refinement)?;
    let numerics: Vec<_> = std::iter::once(usual).chain(finer).collect();
    let model = if cli.table.is_file() {
        read(&cli.table)?
    } else {
        let model = LinearModel::of_case(&case, SIMULATORS, &numerics)?;
        let bytes = bincode::serde::encode_to_vec(&model, bincode::config::standard())?;
        fs::write(&cli.table, bytes).with_context(|| format!("writing {}", cli.table.display()))?;
        model
    };
    anyhow::ensure!(
        model.is_of(&case, &numerics),
        "{} is the table of another case, or of other start values; remove it",
        cli.table.display()
    );
    let rig = Rig::new(&model, &case, (loaded.cycles, numerics));
    let limits = rig.limits()?;
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "| x limit | model error | slow noise | condition | sets | right | wrong |\n|---|---|---|---|---|---|---|"
    )?;
    for row in rows(cli.times) {
        let counts = rig.counts(row, cli.sets, &limits)?;
        let (sets, right, wrong) = (counts.sets, counts.right, counts.wrong.len());
        writeln!(out, "| {row} | {sets} | {right} | {wrong} |")?;
        if cli.lines {
            for line in counts.wrong.into_iter().chain(counts.missed) {
                writeln!(out, "  {line}")?;
            }
        }
    }
    Ok(())
}

fn read(table: &Path) -> anyhow::Result<LinearModel> {
    let bytes = fs::read(table).with_context(|| format!("reading {}", table.display()))?;
    let limit = bincode::config::standard().with_limit::<1_000_000_000>();
    let (model, _) = bincode::serde::decode_from_slice(&bytes, limit)
        .with_context(|| format!("{} is no table of rejudge; remove it", table.display()))?;
    Ok(model)
}
