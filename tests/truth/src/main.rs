//! Command line program `truth`: `make` generates sealed sets, `open` scores verdicts, `run` does both with a
//! diagnosis in between, `searches` compares calibrations.
use anyhow::{Context as _, bail, ensure};
use clap::{Args, Parser, Subcommand, ValueEnum};
use protocol::pumping_unit::PumpingUnit;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;
use truth::files::Channels;
use truth::law::{EffectKind, Tolerance};
use truth::machine::Resolution;
use truth::plan::{SetSpec, Stratum, asked_kind, make};
use truth::scoring::Trial;
use truth::seal::Sealed;
use truth::searches::Searches;
use truth::suite::Suite;
use truth::table::table;
use truth::verdict::Verdict;

/// Makes test records with a hidden effect, and scores verdicts about them.
#[derive(Debug, Parser)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Make(Make),
    Open(Open),
    Run(Run),
    Searches(SearchesOf),
}

/// Make sets of records, each in a folder with a random name, and seal the answers.
#[derive(Debug, Args)]
struct Make {
    /// Case folder of the machine.
    #[arg(long)]
    case: PathBuf,
    /// Folder to write the sets into.
    #[arg(long)]
    out: PathBuf,
    /// File of the answers; those of earlier sets are kept. Keep it away from the records.
    #[arg(long)]
    answers: PathBuf,
    /// Seed of all random draws; keep it secret, since it reproduces the answers.
    #[arg(long)]
    seed: u64,
    /// Kind of hidden effects in the sets.
    #[arg(long, value_enum)]
    stratum: StratumChoice,
    /// Effect to hide instead of a drawn one; for `double` one or two, separated by commas.
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    effect: Vec<String>,
    /// Size of the effect as a multiple of its typical size, instead of a drawn one.
    #[arg(long, value_name = "TIMES", allow_negative_numbers = true)]
    times: Option<f64>,
    /// Factor on the noise of all sensors.
    #[arg(long, default_value_t = 1.0)]
    noise: f64,
    /// Cycles of each record.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=200))]
    cycles: u16,
    /// Factor on the errors of instruments, saddle bearing and balance; 0 for none.
    #[arg(long, default_value_t = 1.0)]
    nuisances: f64,
    /// Gauges that are recorded.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4")]
    gauges: Vec<usize>,
    /// Leave out position and torque.
    #[arg(long)]
    without_others: bool,
    /// Simulate with cylinders of 75 mm, for a case whose cylinders are longer.
    #[arg(long)]
    coarse: bool,
    /// Number of sets; the seed increases by one from set to set.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u16).range(1..=1000))]
    count: u16,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum StratumChoice {
    Single,
    Zero,
    Double,
    Outside,
    Below,
    Card,
}

impl From<StratumChoice> for Stratum {
    fn from(choice: StratumChoice) -> Self {
        match choice {
            StratumChoice::Single => Self::Single,
            StratumChoice::Zero => Self::Zero,
            StratumChoice::Double => Self::Double,
            StratumChoice::Outside => Self::Outside,
            StratumChoice::Below => Self::Below,
            StratumChoice::Card => Self::Card,
        }
    }
}

/// Make sets, diagnose each, and print the table of scores. Finished sets are kept: a run that was stopped
/// continues.
#[derive(Debug, Args)]
struct Run {
    /// Case folder of the machine.
    #[arg(long)]
    case: PathBuf,
    /// Folder for records, answers, verdicts and the table.
    #[arg(long)]
    out: PathBuf,
    /// The program under test; its worker must be in the same folder.
    #[arg(long)]
    horsehead: PathBuf,
    /// Seed of all random draws.
    #[arg(long)]
    seed: u64,
    /// Number of sets with one effect. One in four has gauges 1 and 3 only.
    #[arg(long, default_value_t = 30)]
    singles: u16,
    /// Number of sets without an effect.
    #[arg(long, default_value_t = 20)]
    zeros: u16,
    /// Number of sets with two effects.
    #[arg(long, default_value_t = 12)]
    doubles: u16,
    /// Number of sets with one effect that the library does not contain.
    #[arg(long, default_value_t = 10)]
    outside: u16,
    /// Number of sets with a load card truncated to its first harmonics.
    #[arg(long, default_value_t = 4)]
    cards: u16,
    /// Start no further set after this many hours.
    #[arg(long, value_name = "H")]
    hours: Option<f64>,
}

/// Calibrate records by several searches and seeds, and print a table of objectives, stiffness and cost.
/// Existing results are not computed again.
#[derive(Debug, Args)]
struct SearchesOf {
    /// Case folder; its own record is calibrated first.
    #[arg(long)]
    case: PathBuf,
    /// Folders of other records.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    records: Vec<PathBuf>,
    /// Files of answers with the hidden coefficients of the records.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    answers: Vec<PathBuf>,
    /// The program under test; its worker must be in the same folder.
    #[arg(long)]
    horsehead: PathBuf,
    /// Names of the search presets.
    #[arg(long, value_delimiter = ',', default_value = "quick,memetic")]
    presets: Vec<String>,
    /// Seeds used with each preset.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3")]
    seeds: Vec<u64>,
    /// Folder for results and the table.
    #[arg(long)]
    out: PathBuf,
}

/// Open the answers and print the table of scores.
#[derive(Debug, Args)]
struct Open {
    /// File of the answers.
    #[arg(long)]
    answers: PathBuf,
    /// Folder of the verdicts: NAME.json is the output of `horsehead diagnose CASE --measured .../NAME
    /// --output json`.
    #[arg(long)]
    verdicts: PathBuf,
    /// Commitment that `truth make` printed for the answers.
    #[arg(long, value_name = "HEX")]
    commitment: Option<String>,
}

fn main() -> anyhow::Result<()> {
    match Cli::parse().command {
        Command::Make(arguments) => make_sets(&arguments),
        Command::Open(arguments) => open(&arguments),
        Command::Run(arguments) => run_all(&arguments),
        Command::Searches(arguments) => compare(&arguments),
    }
}

fn make_sets(arguments: &Make) -> anyhow::Result<()> {
    let case = case::load(&arguments.case, &case::Overrides::default())?;
    let unit = PumpingUnit::of(case)?;
    ensure!(
        arguments.noise > 0.0 && arguments.noise < 1e3,
        "--noise must be a factor above 0"
    );
    ensure!(
        (0.0..1e3).contains(&arguments.nuisances),
        "--nuisances must be a factor of at least 0"
    );
    let asked = arguments.effect.iter().map(|id| asked_kind(id));
    let asked: Vec<EffectKind> = asked.collect::<anyhow::Result<_>>()?;
    let most = if arguments.stratum == StratumChoice::Double {
        2
    } else {
        1
    };
    ensure!(
        asked.len() <= most,
        "--effect: a set of this stratum hides at most {most} effect(s)"
    );
    let mut sealed = Sealed::load_or_new(&arguments.answers)?;
    let mut commitment = String::new();
    for k in 0..arguments.count {
        let order = SetSpec {
            seed: arguments.seed + u64::from(k),
            stratum: arguments.stratum.into(),
            requested_effects: asked.clone(),
            size_factor: arguments.times,
            noise: arguments.noise,
            cycles: usize::from(arguments.cycles),
            fineness: if arguments.coarse {
                Resolution::COARSE
            } else {
                Resolution::FULL
            },
            tolerance: Tolerance::USUAL.times(arguments.nuisances),
            channels: Channels {
                others: !arguments.without_others,
                ..Channels::default()
            }
            .with_gauges(&arguments.gauges)?,
        };
        let name = sealed.name();
        let folder = arguments.out.join(&name);
        fs::create_dir_all(&folder).with_context(|| format!("making {}", folder.display()))?;
        let answer = make(&unit, &order, &folder, &name)?;
        sealed.sets.insert(name, answer);
        commitment = sealed.save(&arguments.answers)?;
        print(&format!("{}\n", folder.display()))?;
    }
    print(&format!(
        "{} sets sealed; commitment {commitment}\n",
        sealed.sets.len()
    ))
}

fn open(arguments: &Open) -> anyhow::Result<()> {
    let (sealed, commitment) = Sealed::load(&arguments.answers)?;
    if let Some(committed) = &arguments.commitment
        && *committed != commitment
    {
        bail!("the answers do not match --commitment; the commitment of the file is {commitment}");
    }
    let judged = score_table(sealed, &arguments.verdicts)?;
    print(&format!("commitment {commitment}\n\n{judged}"))
}

fn run_all(arguments: &Run) -> anyhow::Result<()> {
    let case = case::load(&arguments.case, &case::Overrides::default())?;
    let suite = Suite {
        unit: PumpingUnit::of(case)?,
        case: &arguments.case,
        out: &arguments.out,
        horsehead: &arguments.horsehead,
        seed: arguments.seed,
        time_limit: arguments
            .hours
            .map(|hours| Duration::from_secs_f64(3600.0 * hours)),
    };
    let counts = [
        (Stratum::Single, arguments.singles),
        (Stratum::Zero, arguments.zeros),
        (Stratum::Double, arguments.doubles),
        (Stratum::Outside, arguments.outside),
        (Stratum::Card, arguments.cards),
    ];
    suite.run(&counts, &mut |line| print(&format!("{line}\n")))?;
    let (sealed, _) = Sealed::load(&suite.answers())?;
    let judged = score_table(sealed, &suite.verdicts())?;
    fs::write(arguments.out.join("table.md"), &judged)?;
    print(&judged)
}

fn compare(arguments: &SearchesOf) -> anyhow::Result<()> {
    let searches = Searches {
        case: &arguments.case,
        records: &arguments.records,
        answers: &arguments.answers,
        horsehead: &arguments.horsehead,
        presets: &arguments.presets,
        seeds: &arguments.seeds,
        unknown: "kb1",
        out: &arguments.out,
    };
    let table = searches.run(&mut |line| print(&format!("{line}\n")))?;
    print(&table)
}

/// Returns the score table of all sets that have a verdict.
fn score_table(sealed: Sealed, verdicts: &Path) -> anyhow::Result<String> {
    let mut trials = Vec::new();
    let mut without = 0;
    for (name, answer) in sealed.sets {
        let path = verdicts.join(format!("{name}.json"));
        if !path.is_file() {
            without += 1;
            continue;
        }
        trials.push(Trial {
            verdict: Verdict::load(&path)?,
            name,
            answer,
        });
    }
    Ok(table(&trials, without)?)
}

/// Writes text to standard output; ignores a closed pipe.
fn print(text: &str) -> anyhow::Result<()> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        Ok(()) | Err(_) => Ok(()),
    }
}
