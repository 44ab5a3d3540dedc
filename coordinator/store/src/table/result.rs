//! Definition of the exported tables of results: requested simulations, outcome, cost, and scores.
use super::about::{column, gene_column};
use crate::{
    column::{Columns, JOB},
    row::{Brief, EffectRow, Evaluated, Scored},
};
use protocol::{
    case::{Case, Channel},
    job::Counters,
};

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
            "purpose in the search, or stage of the diagnosis",
            |row| Some(row.purpose.clone()),
        )
        .text("condition", "working condition", |row| {
            Some(row.condition.clone())
        })
        .integer(
            "effects",
            "number of effects added to those of the case, listed in the table effects",
            |row| Some(row.effects as u64),
        )
        .integer(
            "columns",
            "number of unknowns and effect parameters by which it was differentiated",
            |row| Some(u64::from(row.columns)),
        );
    for (place, gene) in case.unknowns.iter().enumerate() {
        let about = format!("gene {} [{}]", gene.name, gene.unit);
        columns = columns.real(&gene_column(gene), &about, move |row| {
            row.genes.get(place).copied()
        });
    }
    columns.with(outcome(case), |row| &row.result)
}

pub(super) fn results(case: &Case) -> Columns<Brief> {
    Columns::new()
        .integer(JOB, "the job that it answers", |row: &Brief| {
            Some(row.job.0)
        })
        .with(outcome(case), |row| row)
}

/// Returns the columns for the outcome of a job, its worker and its cost.
fn outcome(case: &Case) -> Columns<Brief> {
    let unit = case.objective_unit();
    let fitness = unit.map_or_else(|| "fitness".to_owned(), |unit| squared("fitness", unit));
    let of = unit.map_or_else(String::new, |unit| format!(" [{unit}^2]"));
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
            &fitness,
            &format!("objective if complete, otherwise a penalty larger than every complete objective{of}"),
            |row| row.fitness,
        );
    for (channel, places) in measured(case) {
        let name = squared(&format!("mse_{}", channel.name), &channel.unit);
        let about = format!(
            "mean squared error of {}, in the square of its unit [{}]",
            channel.title, channel.unit
        );
        columns = columns.real(&name, &about, move |row| row.mse(&places));
    }
    columns = columns
        .text(
            "worker",
            "id of the worker; none for a failure that the coordinator recorded",
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
            "coordinator process of the run that dispatched the job, from 1",
            |row| Some(u64::from(row.offered?.0)),
        )
        .integer(
            "attempts",
            "number of attempts of the job in that process, including the one with the result",
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
    for (at, (name, about, _)) in Counters::default().labelled().into_iter().enumerate() {
        columns = columns.integer(name, about, move |row| {
            let (_, _, count) = row.counters()?.labelled()[at];
            Some(count)
        });
    }
    columns
}

/// Returns the distinct names of measured channels over all conditions, each with the indices of its channels
/// in the case. A channel in another unit than all channels of the objective is left out: it need not be simulated.
fn measured(case: &Case) -> Vec<(&Channel, Vec<usize>)> {
    let mut named: Vec<(&Channel, Vec<usize>)> = Vec::new();
    let all = (0..case.conditions.len()).flat_map(|condition| case.measured(condition));
    let fitted = case.channels.iter();
    let fitted = fitted.filter(|own| case.objective.names(&own.name));
    let units: Vec<&String> = fitted.map(|own| &own.unit).collect();
    let all = all.filter(|(_, channel, _)| units.is_empty() || units.contains(&&channel.unit));
    for (at, channel, _) in all {
        match named
            .iter_mut()
            .find(|(known, _)| known.name == channel.name)
        {
            Some((_, places)) => places.push(at),
            None => named.push((channel, vec![at])),
        }
    }
    named
}

/// Returns the name of a column whose values are in the square of a unit.
fn squared(name: &str, unit: &str) -> String {
    column(name, &format!("{unit}2"))
}

pub(super) fn scores(case: &Case) -> Columns<Scored> {
    let of = |text: fn(&Channel) -> &String| {
        let texts: Vec<String> = case.channels.iter().map(text).cloned().collect();
        move |row: &Scored| texts.get(row.score.channel).cloned()
    };
    Columns::new()
        .integer(JOB, "the job that was scored", |row: &Scored| {
            Some(row.job.0)
        })
        .text(
            "channel",
            "name of the channel",
            of(|channel| &channel.name),
        )
        .text("unit", "unit of the channel", of(|channel| &channel.unit))
        .real(
            "mse",
            "mean squared error as the objective treats the offset [unit^2]",
            |row| Some(row.score.mse),
        )
        .real(
            "mse_fixed_offset",
            "mean squared error of absolute values [unit^2]",
            |row| Some(row.score.mse_fixed_offset),
        )
        .real("offset", "measured minus simulated mean [unit]", |row| {
            Some(row.score.offset)
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
            "simulated minus measured range from lowest to highest, over the measured one [1]",
            |row| Some(row.score.peak_to_peak_error),
        )
}

pub(super) fn effects() -> Columns<EffectRow> {
    Columns::new()
        .integer(JOB, "the simulation that had it", |row: &EffectRow| {
            Some(row.job.0)
        })
        .text("effect", "identifier", |row| Some(row.effect.clone()))
        .text(
            "parameter",
            "name of the parameter; none for an effect whose parameters are all set by the model",
            |row| Some(row.parameter.as_ref()?.0.clone()),
        )
        .real("value", "in the unit that the effect declares", |row| {
            Some(row.parameter.as_ref()?.1)
        })
}
