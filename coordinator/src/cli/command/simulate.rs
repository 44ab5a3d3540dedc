//! `horsehead simulate`: simulates one individual under one condition.
use crate::cli::{
    argument::{
        case::CaseChoice,
        derivatives::columns,
        individual::IndividualChoice,
        output::{Output, OutputChoice},
    },
    output::{
        files::check_out, model, object::simulation::simulation, problem::EXIT_CODES, terminal,
    },
};
use anyhow::Context as _;
use clap::Args;
use protocol::{case::Case, job::Verdict};
use report::{self, Origin, SingleRun, table, words};
use run::{command_line::command_line, hash, manifest, message, session::temporary::compare_once};
use std::path::PathBuf;
use study::{
    self, CompareRequest, Compared, ComparedCurves, EvaluatorError, NamedIndividual, PICTURES,
};

/// Simulate once: curves, verdict, counters.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead simulate cases/cyjs10-5-37hb
  horsehead simulate cases/cyjs10-5-37hb --genes cases/cyjs10-5-37hb/table3_optimised.toml \\
      --condition 4rpm --out simulated
  horsehead simulate cases/cyjs10-5-37hb --derivatives all --out simulated

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    #[command(flatten)]
    individual: IndividualChoice,
    /// Folder for the report, the figures and the curves; nothing is written if it is not given.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    /// Write into a folder that holds other files, a case or a run, and replace files of the same names.
    #[arg(long, env = "HORSEHEAD_FORCE")]
    force: bool,
    /// Also differentiate the curves by unknowns separated by commas, parameters of effects as
    /// EFFECT.PARAMETER (whether the case has the effect or not), or `all` that the case has.
    #[arg(long, value_name = "NAMES|all", env = "HORSEHEAD_DERIVATIVES")]
    derivatives: Option<String>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Simulates the chosen individual, prints the results, and writes the report if a folder was given.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let (loaded, start) = arguments.choice.load_at(arguments.individual.file())?;
    let case = &loaded.case;
    let condition = arguments.individual.condition(case)?;
    let genes = start.map_or_else(|| case.start(), |start| start.genes);
    if let Some(folder) = &arguments.out {
        check_out(folder, arguments.force)?;
    }
    let columns = match &arguments.derivatives {
        Some(typed) => columns(case, typed)?,
        None => Vec::new(),
    };
    let derived: Vec<String> = columns.iter().map(|column| column.name.clone()).collect();
    let pictures = if arguments.out.is_some() { PICTURES } else { 0 };
    let outside = outside_bounds(case, &genes);
    message::print_notes(&outside);
    let mut notes = loaded.notes.clone();
    notes.extend(outside);
    let wanted = CompareRequest {
        condition,
        first: 0,
        individuals: vec![NamedIndividual::new(&arguments.individual.genes, genes)],
        frames: pictures,
        columns,
    };
    let groups = compare_once("simulate", case, std::slice::from_ref(&wanted), 1)?;
    let mismatches = study::mismatches(case, &loaded.cycles, &groups);
    message::print_notes(&mismatches);
    notes.extend(mismatches);
    let curves = first(groups).context("no result came back")?;

    let verdict = curves.drawn.verdict;
    let digest = model::of(case).digest(&curves.drawn)?;
    let run = SingleRun {
        case: case.clone(),
        origin: Origin {
            program: manifest::PROGRAM.to_owned(),
            command: command_line(),
            run: format!("{} {}", case.name, case.conditions[condition].name),
            case_hash: hash::case_hash(case)?,
            measured_name: loaded.measured.clone(),
            preset: None,
            seed: None,
            digest: digest.clone(),
            synthetic: loaded.synthetic,
        },
        condition,
        genes_name: arguments.individual.genes.clone(),
        genes: curves.genes.clone(),
        evaluation: curves.evaluation.clone(),
        curves: curves.drawn.clone(),
        derived: derived.clone(),
        notes,
    };
    if let Some(folder) = &arguments.out {
        let files = report::write_simulation(folder, &run)?;
        if let Some(first) = files.first() {
            message::print(&format!(
                "wrote {} files; open {}",
                files.len(),
                first.display()
            ));
        }
    }
    if arguments.out.is_none() && arguments.output.output == Output::Table {
        message::print("add --out DIR for the report with figures and curves");
    }
    let object = simulation((case, condition), &curves, &derived, digest)?;
    let tables = || {
        let tables = report::ranges(&run).into_iter();
        let tables = tables.chain(report::agreement(&run));
        let tables = tables.chain(report::derivatives(&run));
        let texts = tables.map(|table| table::text(&table, terminal::style()));
        texts.collect::<Vec<_>>().join("\n")
    };
    terminal::print(arguments.output.output, tables, &object)?;
    ended(&verdict)
}

/// Returns an error if the simulation did not complete; its results have already been printed.
fn ended(verdict: &Verdict) -> anyhow::Result<()> {
    if *verdict == Verdict::Complete {
        return Ok(());
    }
    let help = "what it did until then is shown; other values of the unknowns, given with --genes FILE, may \
                complete it";
    Err(EvaluatorError {
        message: format!("the simulation {}", words::verdict(verdict)),
        help: Some(help.to_owned()),
        can_go_on: false,
    }
    .into())
}

/// Describes every gene that lies outside the case's search bounds, one sentence each.
fn outside_bounds(case: &Case, genes: &[f64]) -> Vec<String> {
    let genes = case.unknowns.iter().zip(genes);
    genes
        .filter(|(gene, value)| !(gene.lower..=gene.upper).contains(value))
        .map(|(gene, value)| {
            let (name, unit) = (&gene.name, &gene.unit);
            let (lower, upper) = (gene.lower, gene.upper);
            format!(
                "{name} = {value:e} {unit} lies outside the case's search bounds, {lower:e} to \
                 {upper:e} {unit}"
            )
        })
        .collect()
}

fn first(groups: Vec<Compared>) -> Option<ComparedCurves> {
    groups.into_iter().next()?.individuals.into_iter().next()
}

#[cfg(test)]
mod tests {
    use super::outside_bounds;
    use std::path::Path;

    #[test]
    fn genes_outside_the_bounds_are_noted() {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
        let case = case::load(&shipped, &case::Overrides::default()).unwrap();
        let mut genes = case.start();
        assert_eq!(outside_bounds(&case, &genes), [""; 0]);
        genes[1] = 2.0 * case.unknowns[1].upper;
        let notes = outside_bounds(&case, &genes);
        assert_eq!(notes.len(), 1);
        assert!(notes[0].starts_with("kb23 = "), "{}", notes[0]);
    }
}
