//! `horsehead simulate`: one run of the machine.
use super::{
    CaseChoice, EXIT_CODES, IndividualChoice, OutputChoice, bus, json, output,
    problem::Usage,
    run_folder::{RunFolder, command_line},
};
use crate::{
    report::{self, Provenance, SingleRun, table, words},
    study::{self, Compared, Curves, Wanted, simulation_digest},
};
use anyhow::Context as _;
use clap::Args;
use protocol::{case::Case, job::Verdict};
use std::path::{Path, PathBuf};

/// Simulate one revolution: curves, verdict, counters.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Examples:
  horsehead simulate cases/cyjs10-5-37hb
  horsehead simulate cases/cyjs10-5-37hb --genes cases/cyjs10-5-37hb/table3_optimised.toml \\
      --condition 4rpm --out simulated

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    #[command(flatten)]
    individual: IndividualChoice,
    /// Folder for the report, the figures and the curves; none are written without.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_OUT")]
    out: Option<PathBuf>,
    #[command(flatten)]
    output: OutputChoice,
}

/// Simulates and shows.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let loaded = arguments.choice.load()?;
    let case = &loaded.case;
    let condition = arguments.individual.condition(case)?;
    let genes = arguments.individual.genes(case)?;
    if let Some(folder) = &arguments.out {
        check_out(folder)?;
    }
    let motion_step_deg = if arguments.out.is_some() { 3.0 } else { 0.0 };
    let mut notes = loaded.notes.clone();
    for note in outside_bounds(case, &genes) {
        output::tell(&format!("note: {note}"));
        notes.push(note);
    }
    let wanted = Wanted {
        condition,
        individuals: vec![(arguments.individual.genes.clone(), genes)],
        motion_step_deg,
    };
    let groups = compare_once("simulate", case, std::slice::from_ref(&wanted), 1)?;
    let curves = first(groups).context("no result came back")?;

    let verdict = curves.simulation.verdict;
    if verdict != Verdict::Complete {
        output::tell(&format!("the machine {}", words::verdict(&verdict)));
    }
    let run = SingleRun {
        case: case.clone(),
        provenance: Provenance {
            program: bus::PROGRAM.to_owned(),
            command: command_line(),
            run: format!("{} {}", case.name, case.conditions[condition].name),
            case_hash: bus::case_hash(case)?,
            measured_name: loaded.measured.clone(),
            preset: None,
            seed: None,
            digest: simulation_digest(&curves.simulation),
            synthetic: loaded.synthetic,
        },
        condition,
        genes_name: arguments.individual.genes.clone(),
        genes: curves.genes.clone(),
        evaluation: curves.evaluation.clone(),
        simulation: curves.simulation.clone(),
        notes,
    };
    if let Some(folder) = &arguments.out {
        let files = report::write_simulation(folder, &run)?;
        if let Some(first) = files.first() {
            output::tell(&format!(
                "wrote {} files; open {}",
                files.len(),
                first.display()
            ));
        }
    }
    let object = json::simulation((case, condition), &curves);
    let tables = || table::text(&table::simulation(&run), output::styled());
    output::print(arguments.output.output, tables, &object)
}

/// Refuses a folder that cannot be written, before anything is simulated for it.
pub(super) fn check_out(folder: &Path) -> Result<(), Usage> {
    let tried = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    match tried {
        Ok(_) => Ok(()),
        Err(error) => Err(Usage {
            message: format!("cannot write into {}: {error}", folder.display()),
            help: "choose a folder that can be written, with --out DIR".to_owned(),
        }),
    }
}

/// Genes that a search of this case would never try, one sentence each.
fn outside_bounds(case: &Case, genes: &[f64]) -> Vec<String> {
    let genes = case.genes.iter().zip(genes);
    genes
        .filter(|(gene, value)| !(gene.lower..=gene.upper).contains(value))
        .map(|(gene, value)| {
            let (name, unit) = (gene.label(), gene.unit());
            let (lower, upper) = (gene.lower, gene.upper);
            format!(
                "{name} = {value:e} {unit} lies outside the case's search bounds, {lower:e} to \
                 {upper:e} {unit}"
            )
        })
        .collect()
}

fn first(groups: Vec<Compared>) -> Option<Curves> {
    groups.into_iter().next()?.individuals.into_iter().next()
}

/// Scores and simulates on local workers, without a run folder that outlives the command.
pub(super) fn compare_once(
    kind: &str,
    case: &Case,
    wanted: &[Wanted],
    workers: usize,
) -> anyhow::Result<Vec<Compared>> {
    bus::in_scratch(case, (kind, workers), async |bus, stop| {
        study::compare(bus, case, wanted, stop).await
    })
}

/// Where a run's result was kept, as the tables name it.
pub(super) fn run_name(folder: &RunFolder) -> String {
    folder.path().display().to_string()
}

#[cfg(test)]
mod tests {
    use super::{check_out, outside_bounds};
    use std::path::Path;

    #[test]
    fn genes_outside_the_bounds_are_noted() {
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
        let case = crate::case::load(&shipped, &crate::case::Overrides::default()).unwrap();
        let mut genes = case.recommended();
        assert_eq!(outside_bounds(&case, &genes), [""; 0]);
        genes[1] = 2.0 * case.genes[1].upper;
        let notes = outside_bounds(&case, &genes);
        assert_eq!(notes.len(), 1);
        assert!(notes[0].starts_with("kb23 = "), "{}", notes[0]);
    }

    #[test]
    fn a_file_is_no_folder_for_results() {
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("file");
        std::fs::write(&file, "").unwrap();
        assert!(check_out(&file).is_err());
        check_out(&scratch.path().join("new")).unwrap();
    }
}
