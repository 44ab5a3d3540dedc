//! `truth make`, `truth open`, and `truth run`, which does both with a diagnosis in between.
use anyhow::{Context as _, bail, ensure};
use clap::{Args, Parser, Subcommand, ValueEnum};
use protocol::pumping_unit::PumpingUnit;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::time::Duration;
use truth::files::Channels;
use truth::judge::Trial;
use truth::law::{Kind, Tolerance};
use truth::machine::Fineness;
use truth::plan::{Order, Stratum, asked_kind, make};
use truth::seal::Sealed;
use truth::searches::Searches;
use truth::suite::Suite;
use truth::table::table;
use truth::verdict::Verdict;

/// Makes test records with a hidden effect, and judges verdicts about them.
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

/// Make sets of records, each in a folder with a random name, and seal what they hide.
#[derive(Debug, Args)]
struct Make {
    /// Case folder whose machine it is.
    #[arg(long)]
    case: PathBuf,
    /// Where the folders go.
    #[arg(long)]
    out: PathBuf,
    /// File of the answers; those of earlier sets stay in it. Keep it away from the records.
    #[arg(long)]
    answers: PathBuf,
    /// What everything is drawn from; whoever knows it can draw the answers.
    #[arg(long)]
    seed: u64,
    /// What the sets test.
    #[arg(long, value_enum)]
    stratum: StratumChoice,
    /// Effect to hide, instead of one that is drawn; of a double one or both, by commas.
    #[arg(long, value_name = "ID", value_delimiter = ',')]
    effect: Vec<String>,
    /// Its size in units of its typical size, instead of one that is drawn.
    #[arg(long, value_name = "TIMES", allow_negative_numbers = true)]
    times: Option<f64>,
    /// Factor on the noise of all sensors.
    #[arg(long, default_value_t = 1.0)]
    noise: f64,
    /// Cycles of each record.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=200))]
    cycles: u16,
    /// Factor on what instruments, saddle bearing and balance are off by; 0 for a record without.
    #[arg(long, default_value_t = 1.0)]
    nuisances: f64,
    /// Gauges that are recorded.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3,4")]
    gauges: Vec<usize>,
    /// Leave position and torque out.
    #[arg(long)]
    without_others: bool,
    /// Cylinders of 75 mm, for a case whose own are longer.
    #[arg(long)]
    coarse: bool,
    /// Number of sets; each next one takes the next seed.
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

/// Make sets, diagnose each, and print what the verdicts are worth. What is there already is not done again:
/// a run that was stopped goes on.
#[derive(Debug, Args)]
struct Run {
    /// Case folder whose machine it is.
    #[arg(long)]
    case: PathBuf,
    /// Where records, answers, verdicts and the table go.
    #[arg(long)]
    out: PathBuf,
    /// The program that is judged; its worker lies beside it.
    #[arg(long)]
    horsehead: PathBuf,
    /// What everything is drawn from.
    #[arg(long)]
    seed: u64,
    /// Sets with one effect. Of four sets one has gauges 1 and 3 alone.
    #[arg(long, default_value_t = 30)]
    singles: u16,
    /// Sets without any.
    #[arg(long, default_value_t = 20)]
    zeros: u16,
    /// Sets with two.
    #[arg(long, default_value_t = 12)]
    doubles: u16,
    /// Sets with one that the library does not name.
    #[arg(long, default_value_t = 10)]
    outside: u16,
    /// Sets with a card that was cut to its first harmonics.
    #[arg(long, default_value_t = 4)]
    cards: u16,
    /// Begin no further set after so many hours.
    #[arg(long, value_name = "H")]
    hours: Option<f64>,
}

/// Calibrate records by several searches and seeds, and print a table of objectives, stiffness and cost. What is there
/// already is not run again.
#[derive(Debug, Args)]
struct SearchesOf {
    /// Case folder; its own record is the first.
    #[arg(long)]
    case: PathBuf,
    /// Folders of other records.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    records: Vec<PathBuf>,
    /// Files of what the records hide.
    #[arg(long, value_name = "FILE", num_args = 1..)]
    answers: Vec<PathBuf>,
    /// The program that is judged; its worker lies beside it.
    #[arg(long)]
    horsehead: PathBuf,
    /// Searches, by the names of their presets.
    #[arg(long, value_delimiter = ',', default_value = "quick,memetic")]
    presets: Vec<String>,
    /// Seeds of each.
    #[arg(long, value_delimiter = ',', default_value = "1,2,3")]
    seeds: Vec<u64>,
    /// Where results and the table go.
    #[arg(long)]
    out: PathBuf,
}

/// Open the answers and print what the verdicts are worth.
#[derive(Debug, Args)]
struct Open {
    /// File of the answers.
    #[arg(long)]
    answers: PathBuf,
    /// Folder of the verdicts: NAME.json is what `horsehead diagnose CASE --measured .../NAME --output json`
    /// printed.
    #[arg(long)]
    verdicts: PathBuf,
    /// What the answers were committed to when the records were given away.
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
    let asked: Vec<Kind> = asked.collect::<anyhow::Result<_>>()?;
    let most = if arguments.stratum == StratumChoice::Double {
        2
    } else {
        1
    };
    ensure!(
        asked.len() <= most,
        "--effect: sets of this stratum hide {most} at most"
    );
    let mut sealed = Sealed::load_or_new(&arguments.answers)?;
    let mut commitment = String::new();
    for k in 0..arguments.count {
        let order = Order {
            seed: arguments.seed + u64::from(k),
            stratum: arguments.stratum.into(),
            asked: asked.clone(),
            times: arguments.times,
            noise: arguments.noise,
            cycles: usize::from(arguments.cycles),
            fineness: if arguments.coarse {
                Fineness::COARSE
            } else {
                Fineness::FULL
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
        say(&format!("{}\n", folder.display()))?;
    }
    say(&format!(
        "{} sets sealed; commitment {commitment}\n",
        sealed.sets.len()
    ))
}

fn open(arguments: &Open) -> anyhow::Result<()> {
    let (sealed, commitment) = Sealed::load(&arguments.answers)?;
    if let Some(committed) = &arguments.commitment
        && *committed != commitment
    {
        bail!("the answers are not those that were committed to: {commitment}");
    }
    let judged = judged(sealed, &arguments.verdicts)?;
    say(&format!("commitment {commitment}\n\n{judged}"))
}

fn run_all(arguments: &Run) -> anyhow::Result<()> {
    let case = case::load(&arguments.case, &case::Overrides::default())?;
    let suite = Suite {
        unit: PumpingUnit::of(case)?,
        case: &arguments.case,
        out: &arguments.out,
        horsehead: &arguments.horsehead,
        seed: arguments.seed,
        until: arguments
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
    suite.run(&counts, &mut |line| say(&format!("{line}\n")))?;
    let (sealed, _) = Sealed::load(&suite.answers())?;
    let judged = judged(sealed, &suite.verdicts())?;
    fs::write(arguments.out.join("table.md"), &judged)?;
    say(&judged)
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
    let table = searches.run(&mut |line| say(&format!("{line}\n")))?;
    say(&table)
}

/// The table of all sets that have a verdict.
fn judged(sealed: Sealed, verdicts: &Path) -> anyhow::Result<String> {
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

/// To standard output; a reader that has gone is no error.
fn say(text: &str) -> anyhow::Result<()> {
    match io::stdout().lock().write_all(text.as_bytes()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(error.into()),
        Ok(()) | Err(_) => Ok(()),
    }
}
