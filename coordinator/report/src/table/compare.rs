//! Tables that compare the recommended with the optimised parameters (reference paper, Tables 3 and 4).
use crate::{
    data::{Calibration, ConditionResult},
    document::{Row, Table},
    number::{MISSING, percent, precise, ratio, significant, squared, unit},
    words::{self, condition_name},
};
use protocol::case::{Case, Channel, Offset};
use protocol::job::{ChannelScore, Verdict};

/// Definitions of the error measures, printed below every table of errors.
const DEFINITIONS: [&str; 2] = [
    "Relative error: mean absolute error over the mean absolute deviation of the measured curve from \
     its own mean.",
    "RMSE / half-range: root of the mean squared error over half the measured range.",
];

/// Returns the definition of the offset, and whether the objective removes it.
fn offset_definition(case: &Case, scored: &[usize]) -> String {
    let channels = scored.iter().filter_map(|&at| case.channels.get(at));
    let is_free = |channel: &&Channel| channel.offset == Offset::Free;
    let (free, fixed): (Vec<_>, Vec<_>) = channels.partition(is_free);
    let removed = match (free.is_empty(), fixed.is_empty()) {
        (true, _) => "it counts as error, because the channels have an absolute zero".to_owned(),
        (false, true) => "it is removed, because the channels have no absolute zero".to_owned(),
        (false, false) => {
            let names: Vec<String> = fixed.iter().map(|channel| channel.title.clone()).collect();
            format!(
                "it is removed, except from {}",
                words::join_words(&names, "and")
            )
        }
    };
    format!("Offset: measured minus simulated mean; {removed}.")
}

/// Returns the indices of the case's channels that have a score under the condition or belong to the objective,
/// channels of the objective first.
fn scored(case: &Case, result: &ConditionResult) -> Vec<usize> {
    let has_score = |at: usize| {
        let runs = [&result.recommended, &result.optimised];
        let mut scores = runs.iter().flat_map(|run| &run.evaluation.channels);
        scores.any(|score| score.channel == at)
    };
    let measured = case.measured(result.condition);
    let mut scored: Vec<usize> = measured
        .map(|(at, ..)| at)
        .filter(|&at| has_score(at) || words::is_fitted(case, at))
        .collect();
    scored.sort_by_key(|&at| !words::is_fitted(case, at));
    scored
}

/// Error measure of a channel, such as the relative error, shown for both parameter sets.
struct Measure {
    title: &'static str,
    unit: fn(&str) -> String,
    of: fn(&ChannelScore) -> f64,
    write: fn(f64) -> String,
    /// Whether the ratio of the measure's optimised to its recommended value is meaningful; not so for signed
    /// errors and offsets.
    has_ratio: bool,
}

const MEASURES: [Measure; 6] = [
    Measure {
        title: "Mean squared error",
        unit: |unit| squared(Some(unit)),
        of: |score| score.mse,
        write: significant,
        has_ratio: true,
    },
    Measure {
        title: "MSE, absolute (offset not removed)",
        unit: |unit| squared(Some(unit)),
        of: |score| score.mse_fixed_offset,
        write: significant,
        has_ratio: true,
    },
    Measure {
        title: "Relative error",
        unit: |_| String::new(),
        of: |score| score.relative_error,
        write: percent,
        has_ratio: true,
    },
    Measure {
        title: "RMSE / half-range",
        unit: |_| String::new(),
        of: |score| score.rmse_over_half_range,
        write: percent,
        has_ratio: true,
    },
    Measure {
        title: "Error of the peak-to-peak value",
        unit: |_| String::new(),
        of: |score| score.peak_to_peak_error,
        write: percent,
        has_ratio: false,
    },
    Measure {
        title: "Offset",
        unit,
        of: |score| score.offset,
        write: significant,
        has_ratio: false,
    },
];

impl Measure {
    /// Builds the table row of one channel with this error measure for both parameter sets.
    fn row(&self, case: &Case, result: &ConditionResult, channel: usize) -> Row {
        let [before, after] = [&result.recommended, &result.optimised].map(|run| {
            let mut channels = run.evaluation.channels.iter();
            channels.find(|score| score.channel == channel).map(self.of)
        });
        let share = match (before, after) {
            _ if !self.has_ratio => String::new(),
            (Some(before), Some(after)) if before > 0.0 && after >= 0.0 => ratio(after, before),
            _ => MISSING.to_owned(),
        };
        let write = |value: Option<f64>| value.map_or_else(|| MISSING.to_owned(), self.write);
        let calibrated = case.objective.holds(result.condition);
        let role = if words::is_fitted(case, channel) || !calibrated {
            ""
        } else {
            " (not fitted)"
        };
        let found = case.channels.get(channel);
        let unit = found.map(|channel| (self.unit)(&channel.unit));
        let cells = [unit.unwrap_or_default(), write(before), write(after), share];
        Row::new(
            format!("{}{role}", words::channel_title(case, channel)),
            cells,
        )
    }
}

/// Builds the table rows of the objective and of all error measures under a condition.
fn agreement(case: &Case, result: &ConditionResult) -> Vec<Row> {
    let scored = scored(case, result);
    let [before, after] = [&result.recommended, &result.optimised].map(|run| {
        let complete = run.evaluation.verdict == Verdict::Complete;
        complete.then_some(run.evaluation.fitness)
    });
    let write = |value: Option<f64>| value.map_or_else(|| "failed".to_owned(), significant);
    let share = before
        .zip(after)
        .map(|(before, after)| ratio(after, before));
    let cells = [
        squared(case.objective_unit()),
        write(before),
        write(after),
        share.unwrap_or_else(|| MISSING.to_owned()),
    ];
    let objective = match case.objective.others.len() {
        0 => "Objective".to_owned(),
        _ => format!(
            "Objective, condition {} alone",
            condition_name(case, result.condition)
        ),
    };
    let mut rows = vec![
        Row::group(objective),
        Row::new("weighted sum of mean squared errors", cells),
    ];
    // a limit is not to be met: neither its peaks nor its mean say anything
    let is_limit = |at: usize| case.channels.get(at).is_some_and(|own| own.limit.is_some());
    for measure in MEASURES {
        let mut shown = scored.clone();
        shown.retain(|at| measure.has_ratio || !is_limit(*at));
        if !shown.is_empty() {
            rows.push(Row::group(measure.title));
            rows.extend(shown.iter().map(|&at| measure.row(case, result, at)));
        }
    }
    rows
}

const HEAD: [&str; 5] = [
    "",
    "unit",
    "recommended",
    "optimised",
    "optimised / recommended",
];

/// Builds the table rows of the recommended and optimised gene values.
fn gene_rows(calibration: &Calibration) -> Vec<Row> {
    let intervals = words::intervals(calibration);
    let mut rows = Vec::new();
    let (mut group, kind) = ("", case::kind::of(&calibration.case));
    let genes = calibration.case.unknowns.iter().enumerate();
    for (index, gene) in genes {
        let name = match gene.of_effect() {
            Some(_) => "Effects",
            None => kind.group(gene),
        };
        if name != group {
            rows.push(Row::group(name));
            group = name;
        }
        let value = |genes: &[f64]| genes.get(index).copied().unwrap_or(f64::NAN);
        let before = value(&calibration.recommended.genes);
        let after = value(&calibration.optimised.genes);
        let said = intervals.iter().find(|own| own.name == gene.name);
        let width = said.and_then(|own| Some(own.interval[1]? - own.interval[0]?));
        let mut optimised = precise(after, width.unwrap_or_default());
        if words::at_bound(gene, after).is_some() {
            optimised.push_str(" *");
        }
        let cells = [
            unit(&gene.unit),
            significant(before),
            optimised,
            ratio(after, before),
        ];
        let cells = cells.into_iter().chain(said.map(words::interval_cell));
        rows.push(Row::of(gene, cells));
    }
    rows
}

/// Builds the reference paper's Table 3: genes, and agreement with the measurement under the calibrated
/// condition.
pub fn table_3(calibration: &Calibration) -> Table {
    let case = &calibration.case;
    let title = format!(
        "Recommended and optimised parameters, calibrated {}",
        words::calibrated(case)
    );
    let genes = case.unknowns.iter().zip(&calibration.optimised.genes);
    let bounds: Vec<String> = genes
        .filter_map(|(gene, &value)| {
            let bound = words::bound(gene, words::at_bound(gene, value)?);
            Some(format!("{} at {bound}", gene.name))
        })
        .collect();
    let marked =
        (!bounds.is_empty()).then(|| format!("* at a bound of the search: {}.", bounds.join(", ")));
    let mut table = Table::new(title, HEAD, gene_rows(calibration)).with_notes(marked);
    table = table.with_notes(words::lacks_intervals(calibration));
    if !words::intervals(calibration).is_empty() {
        table.head.push("what the record says, 95 %".to_owned());
        let of = match case.objective.others.len() {
            0 => "the record".to_owned(),
            _ => format!(
                "the record of condition {}",
                condition_name(case, case.objective.condition)
            ),
        };
        table = table.with_notes([format!(
            "What the record says: what {of} does, to first order at the optimum, under its own noise, widened \
             by what is left; `horsehead identify RUN` says it with profiles."
        )]);
    }
    table = table.with_notes(DEFINITIONS.map(str::to_owned));
    if let Some(result) = calibration.calibrated() {
        table.rows.extend(agreement(case, result));
        table = table
            .with_notes([offset_definition(case, &scored(case, result))])
            .with_notes(remarks(case, result));
    }
    table
}

/// Builds the table of the best fit and of the rival fits of other families, with the objective of each;
/// `None` if there is no rival.
pub fn rivals(calibration: &Calibration) -> Option<Table> {
    let Calibration { case, rivals, .. } = calibration;
    if rivals.is_empty() {
        return None;
    }
    let (_, best) = calibration.objective(|result| &result.optimised)?;
    let mut table = Table::new(
        "Fits of other families with nearly the same objective",
        ["", "unit", "optimised"],
        Vec::new(),
    );
    let numbers = 1..=rivals.len();
    table.head.extend(numbers.map(|k| format!("rival {k}")));
    let fits = std::iter::once(&calibration.optimised.genes);
    let fits = fits.chain(rivals.iter().map(|rival| &rival.genes));
    for (index, unknown) in case.unknowns.iter().enumerate() {
        let value = |genes: &Vec<f64>| {
            let value = genes.get(index).copied().unwrap_or(f64::NAN);
            let bound = words::at_bound(unknown, value).map_or("", |_| " *");
            format!("{}{bound}", significant(value))
        };
        let cells = [unit(&unknown.unit)].into_iter();
        table
            .rows
            .push(Row::of(unknown, cells.chain(fits.clone().map(value))));
    }
    let objectives = std::iter::once(best).chain(rivals.iter().map(|rival| rival.objective));
    let cells = [squared(case.objective_unit())].into_iter();
    let cells = cells.chain(objectives.map(significant));
    table.rows.push(Row::new("Objective", cells));
    let note = "A rival is the end of a descent whose objective is at most 1.5 times the best, and which differs by more than \
                half a decade (on a linear axis, a quarter of the interval) in an unknown that the record bounds on both sides \
                at the best fit. * at a bound of the search.";
    Some(table.with_notes([note]))
}

/// Builds the reference paper's Table 4: agreement with the measurement under another condition, with the
/// parameters of the calibration unchanged.
pub fn table_4(case: &Case, result: &ConditionResult) -> Table {
    let role = if !case.objective.holds(result.condition) {
        "which took no part in the fit"
    } else if case.objective.others.is_empty() {
        "the calibrated condition"
    } else {
        "one of the calibrated conditions"
    };
    let name = condition_name(case, result.condition);
    let title = format!("The same parameters under condition {name}, {role}");
    Table::new(title, HEAD, agreement(case, result))
        .with_notes(DEFINITIONS.map(str::to_owned))
        .with_notes([offset_definition(case, &scored(case, result))])
        .with_notes(remarks(case, result))
}

/// Lists remarks on a condition's channels whose absolute error rose although a free offset hides it, and on
/// failed simulations.
fn remarks(case: &Case, result: &ConditionResult) -> Vec<String> {
    let runs = [
        ("Recommended", &result.recommended),
        ("Optimised", &result.optimised),
    ];
    let failed = runs.into_iter().filter_map(|(who, run)| {
        let verdict = &run.evaluation.verdict;
        let failed = *verdict != Verdict::Complete;
        failed.then(|| format!("{who} parameters {}.", words::verdict(verdict)))
    });
    let worse = words::absolute_worse(case, result);
    worse.into_iter().chain(failed).collect()
}
