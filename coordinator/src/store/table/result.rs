//! Tables of results: what was asked, how it ended, what it cost, how well it agrees.
use super::about::gene_column;
use crate::store::{
    column::{Columns, JOB},
    row::{Added, Brief, Evaluated, Scored},
};
use protocol::{case::Case, job::Counters};

/// Gauges of the machine.
const GAUGES: u8 = 4;

pub(super) fn evaluations(case: &Case) -> Columns<Evaluated> {
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

pub(super) fn results() -> Columns<Brief> {
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
    columns = columns
        .text(
            "worker",
            "who did it; none for a failure that the coordinator stated",
            |row| Some(row.worker?.to_string()),
        )
        .real("wall_s", "time in the slot [s]", |row| {
            Some(row.cost.wall_s())
        })
        .real("cpu_s", "processor time in the slot [s]", |row| {
            Some(row.cost.cpu_s())
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
    for (at, (name, about, _)) in Counters::default().named().into_iter().enumerate() {
        columns = columns.integer(name, about, move |row| {
            let (_, _, count) = row.counters()?.named()[at];
            Some(count)
        });
    }
    columns
}

pub(super) fn scores() -> Columns<Scored> {
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

pub(super) fn effects() -> Columns<Added> {
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
