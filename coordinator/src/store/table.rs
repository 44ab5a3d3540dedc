//! The tables: what there is to query, each column once.
//!
//! A new column is a line here; a new table a function here, a line in [`Tables::begin`] and the
//! place where its rows come from.
use super::{
    StoreError,
    book::{Book, Table},
    column::{Column, Columns},
    row::{Added, Brief, Evaluated, Fact, Happened, Scored},
};
use crate::journal::Damage;
use protocol::{
    case::{Case, Gene, Quantity},
    event::{Spent, WorkerAccount},
    job::Counters,
    unit::Unit,
};

/// Gauges of the machine.
const GAUGES: u8 = 4;

/// One of the counts of a simulation's work.
type Count = fn(Counters) -> u64;

/// Every table of an export.
pub(super) struct Tables {
    pub(super) run: Table<Fact>,
    pub(super) genes: Table<Gene>,
    pub(super) evaluations: Table<Evaluated>,
    pub(super) effects: Table<Added>,
    pub(super) results: Table<Brief>,
    pub(super) scores: Table<Scored>,
    pub(super) workers: Table<WorkerAccount>,
    pub(super) events: Table<Happened>,
    pub(super) damage: Table<Damage>,
    pub(super) dictionary: Table<(String, Column)>,
}

impl Tables {
    /// Begins all of them.
    pub(super) fn begin(book: &mut Book, case: &Case) -> Result<Self, StoreError> {
        Ok(Self {
            run: book.begin("run", run())?,
            genes: book.begin("genes", genes())?,
            evaluations: book.begin("evaluations", evaluations(case))?,
            effects: book.begin("effects", effects())?,
            results: book.begin("results", results())?,
            scores: book.begin("scores", scores())?,
            workers: book.begin("workers", workers())?,
            events: book.begin("events", events())?,
            damage: book.begin("damage", damage())?,
            dictionary: book.begin("dictionary", dictionary())?,
        })
    }
}

/// Their names.
pub(super) const NAMES: [&str; 10] = [
    "run",
    "genes",
    "evaluations",
    "effects",
    "results",
    "scores",
    "workers",
    "events",
    "damage",
    "dictionary",
];

/// The name of every job column: databases look rows up by it.
pub(super) const JOB: &str = "job";

fn run() -> Columns<Fact> {
    Columns::new()
        .text("name", "what is known of the run", |fact: &Fact| {
            Some(fact.name.clone())
        })
        .text("value", "its value", |fact| Some(fact.value.clone()))
}

/// Name of the column of a gene, with its unit: `kb1_n_per_m`.
fn gene_column(gene: &Gene) -> String {
    let unit = gene.unit().to_lowercase();
    let unit = unit.replace('/', "_per_").replace(['.', '^'], "_");
    let name = gene.label().replace('.', "_");
    format!("{name}_{unit}")
}

const fn coefficient_unit(gene: &Gene) -> Option<Unit> {
    match gene.quantity {
        Quantity::Coefficient { unit, .. } => Some(unit),
        Quantity::Effect { .. } => None,
    }
}

fn genes() -> Columns<Gene> {
    Columns::new()
        .text("gene", "its name in the case", |gene: &Gene| {
            Some(gene.label())
        })
        .text("column", "its column in the table evaluations", |gene| {
            Some(gene_column(gene))
        })
        .text("unit", "unit that the case states it in", |gene| {
            Some(gene.unit().to_owned())
        })
        .real("recommended", "recommended value, in that unit", |gene| {
            Some(gene.recommended)
        })
        .real("lower", "smallest value to search", |gene| Some(gene.lower))
        .real("upper", "largest value to search", |gene| Some(gene.upper))
        .text(
            "si_unit",
            "its SI unit; none for a parameter of an effect",
            |gene| Some(coefficient_unit(gene)?.si().symbol().to_owned()),
        )
        .real(
            "si_factor",
            "what one of the unit is in SI; none for a parameter of an effect",
            |gene| Some(coefficient_unit(gene)?.si_factor()),
        )
}

fn evaluations(case: &Case) -> Columns<Evaluated> {
    let job = |row: &Evaluated| Some(row.result.job.0);
    let mut columns = Columns::new()
        .integer(JOB, "number of the evaluation; in a search, its index", job)
        .integer(
            "generation",
            "generation it was proposed in; none outside a search",
            |row| row.generation.map(u64::from),
        )
        .text(
            "purpose",
            "what the search, or which stage of the diagnosis, wanted it for",
            |row| Some(row.purpose.clone()),
        )
        .text("condition", "working condition", |row| {
            Some(row.condition.clone())
        })
        .integer(
            "effects",
            "effects beside those of the case; the table effects has them",
            |row| Some(row.effects as u64),
        );
    for (place, gene) in case.genes.iter().enumerate() {
        let about = format!("gene {} [{}]", gene.label(), gene.unit());
        columns = columns.real(&gene_column(gene), &about, move |row| {
            row.genes.get(place).copied()
        });
    }
    columns.with(outcome(), |row| &row.result)
}

fn results() -> Columns<Brief> {
    Columns::new()
        .integer(JOB, "the job that it answers", |row: &Brief| {
            Some(row.job.0)
        })
        .with(outcome(), |row| row)
}

/// How a job ended, who did it and what it cost.
fn outcome() -> Columns<Brief> {
    let mut columns = Columns::new()
        .text(
            "kind",
            "kind of the job; failed if it could not be done",
            |row: &Brief| Some(row.kind.to_owned()),
        )
        .text(
            "verdict",
            "complete, or what ended the simulation early; none where nothing was simulated",
            |row| Some(row.simulated?.0.as_str().to_owned()),
        )
        .real(
            "load_fraction",
            "share of the static load at which the simulation failed",
            |row| row.simulated?.0.load_fraction(),
        )
        .real(
            "time_fraction",
            "share of the simulated time at which the simulation failed",
            |row| row.simulated?.0.time_fraction(),
        )
        .real(
            "fitness_mpa2",
            "objective if complete, a grade above every complete one's otherwise [MPa^2]",
            |row| row.fitness_mpa2,
        );
    for gauge in 1..=GAUGES {
        let (name, about) = (
            format!("mse_gauge_{gauge}_mpa2"),
            format!("mean squared error at gauge {gauge} [MPa^2]"),
        );
        columns = columns.real(&name, &about, move |row| row.mse_mpa2(gauge));
    }
    let counters: [(&str, &str, Count); 5] = [
        ("steps", "accepted steps", |work| work.steps),
        ("rejected_steps", "rejected steps", |work| {
            work.rejected_steps
        }),
        ("newton_iterations", "Newton iterations", |work| {
            work.newton_iterations
        }),
        ("jacobians", "tangent evaluations", |work| work.jacobians),
        ("factorizations", "factorisations", |work| {
            work.factorizations
        }),
    ];
    columns = columns
        .text(
            "worker",
            "who did it; none for a failure that the coordinator stated",
            |row| Some(row.worker?.to_string()),
        )
        .real("wall_s", "time in the slot [s]", |row| {
            Some(row.wall_us as f64 / 1e6)
        })
        .integer(
            "process",
            "coordinator process of the run that offered it, from 1",
            |row| Some(u64::from(row.offered?.0)),
        )
        .integer(
            "attempts",
            "offers of the job in that process until the one that brought the result",
            |row| Some(u64::from(row.offered?.1) + 1),
        )
        .text(
            "failure_kind",
            "why the job could not be done: deadline, crashed, lost, refused, misconfigured",
            |row| Some(row.failure.as_ref()?.kind().to_owned()),
        )
        .text("failure", "the same in words", |row| {
            Some(row.failure.as_ref()?.to_string())
        });
    for (name, about, read) in counters {
        columns = columns.integer(name, about, move |row| row.counters().map(read));
    }
    columns
}

fn scores() -> Columns<Scored> {
    Columns::new()
        .integer(JOB, "the job that was scored", |row: &Scored| {
            Some(row.job.0)
        })
        .integer("gauge", "gauge number", |row| {
            Some(u64::from(row.score.gauge))
        })
        .real(
            "mse_mpa2",
            "mean squared error as the objective treats the offset [MPa^2]",
            |row| Some(row.score.mse_mpa2),
        )
        .real(
            "mse_fixed_offset_mpa2",
            "mean squared error of absolute values [MPa^2]",
            |row| Some(row.score.mse_fixed_offset_mpa2),
        )
        .real("offset_mpa", "measured minus simulated mean [MPa]", |row| {
            Some(row.score.offset_mpa)
        })
        .real(
            "rmse_over_half_range",
            "root mean squared error over half the measured range [1]",
            |row| Some(row.score.rmse_over_half_range),
        )
        .real(
            "relative_error",
            "mean absolute error over the mean absolute deviation of the measured curve [1]",
            |row| Some(row.score.relative_error),
        )
        .real(
            "peak_to_peak_error",
            "simulated minus measured peak-to-peak stress, over the measured one [1]",
            |row| Some(row.score.peak_to_peak_error),
        )
}

fn effects() -> Columns<Added> {
    Columns::new()
        .integer(JOB, "the simulation that had it", |row: &Added| {
            Some(row.job.0)
        })
        .text("effect", "identifier", |row| Some(row.effect.clone()))
        .text(
            "parameter",
            "its name; none for an effect all of whose parameters are the model's",
            |row| Some(row.parameter.as_ref()?.0.clone()),
        )
        .real("value", "in the unit that the effect declares", |row| {
            Some(row.parameter.as_ref()?.1)
        })
}

fn workers() -> Columns<WorkerAccount> {
    let mut columns = Columns::new()
        .text("worker", "its id", |row: &WorkerAccount| {
            Some(row.worker.to_string())
        })
        .text("host", "its machine", |row| Some(row.host.clone()))
        .integer("slots", "jobs it does at a time", |row| {
            Some(u64::from(row.slots))
        })
        .integer("done", "results of it that were accepted", |row| {
            Some(row.done)
        })
        .integer("failed", "attempts that failed there", |row| {
            Some(row.failed)
        })
        .real("connected_s", "slots times time connected [s]", |row| {
            Some(row.spent.connected_us as f64 / 1e6)
        });
    for (place, (kind, _)) in Spent::default().kinds().into_iter().enumerate() {
        let (name, about) = (
            format!("{kind}_s"),
            format!("of that, {kind}, as `horsehead explain` has it [s]"),
        );
        columns = columns.real(&name, &about, move |row| {
            let (_, us) = row.spent.kinds().into_iter().nth(place)?;
            Some(us as f64 / 1e6)
        });
    }
    columns
}

fn events() -> Columns<Happened> {
    Columns::new()
        .integer(
            "journal_byte",
            "where it stands in the journal",
            |row: &Happened| Some(row.at_byte),
        )
        .integer("process", "coordinator process of the run, from 1", |row| {
            row.process.map(u64::from)
        })
        .integer("at_unix_ms", "when [ms since 1970 UTC]", |row| {
            row.at_unix_ms
        })
        .text("event", "opened, joined, left, proved or closed", |row| {
            Some(row.event.to_owned())
        })
        .text("worker", "whom it concerns", |row| {
            Some(row.worker?.to_string())
        })
        .text("host", "machine of a worker that joined", |row| {
            row.host.clone()
        })
        .integer("slots", "slots of a worker that joined", |row| {
            row.slots.map(u64::from)
        })
        .text(
            "detail",
            "why a worker left; model digest of one that joined; what the reference individual \
             came to",
            |row| row.detail.clone(),
        )
}

fn damage() -> Columns<Damage> {
    Columns::new()
        .integer(
            "journal_byte",
            "where a stretch begins that could not be read",
            |row: &Damage| Some(row.at),
        )
        .integer("bytes", "how long it is", |row| Some(row.bytes))
        .text(
            "kind",
            "damaged, or torn: an unfinished record at the end",
            |row| Some(if row.torn { "torn" } else { "damaged" }.to_owned()),
        )
}

fn dictionary() -> Columns<(String, Column)> {
    Columns::new()
        .text("table_name", "table", |(table, _): &(String, Column)| {
            Some(table.clone())
        })
        .text("column_name", "column", |(_, column)| {
            Some(column.name.clone())
        })
        .text("kind", "integer, real or text", |(_, column)| {
            Some(column.kind.as_str().to_owned())
        })
        .text("meaning", "what it says, with its unit", |(_, column)| {
            Some(column.about.clone())
        })
}
