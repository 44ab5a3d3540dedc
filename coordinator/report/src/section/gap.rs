//! Report section on the remaining gap between simulation and measurement, by channel.
use crate::data::{Calibration, ConditionResult};
use crate::document::{Row, Section, Table, tables};
use crate::number::{MISSING, fixed, percent, quantity, significant};
use crate::words::condition_name;
use discrepancy::validation::gap::{Gap, SECTORS};
use protocol::case::{Abscissa, Case};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let results = calibration.conditions.iter();
    Section {
        id: "gap",
        title: "Where the gap remains",
        blocks: tables(results.filter_map(|result| gap(&calibration.case, result))),
    }
}

/// Builds the table of the gap between simulation and measurement under one condition, for the recommended
/// and the optimised parameters; `None` without a measured record or a complete run.
fn gap(case: &Case, result: &ConditionResult) -> Option<Table> {
    let [before, after] =
        [&result.recommended, &result.optimised].map(|run| run.gaps(case, result.condition));
    if after.is_empty() {
        return None;
    }
    let rows = after
        .iter()
        .map(|(channel, gap)| {
            let mut before = before.iter();
            let earlier = before.find(|(before, _)| before.name == channel.name);
            Row::new(
                channel.title.as_str(),
                [
                    earlier.map_or_else(|| "–".to_owned(), |(_, gap)| percent(gap.share())),
                    percent(gap.share()),
                    gap.over_noise().map_or_else(
                        || "unknown".to_owned(),
                        |ratio| format!("{} ×", fixed(ratio, 1)),
                    ),
                    sector(&channel.abscissa, gap),
                    band(&channel.abscissa, gap),
                ],
            )
        })
        .collect();
    Some(Table::new(format!(
            "What remains unexplained under condition {}",
            condition_name(case, result.condition)
        ), [
            "",
            "gap, recommended",
            "gap, optimised",
            "times the noise",
            "worst sector",
            "worst band of orders",
        ], rows).with_notes([
            "Times the noise: root mean square of the residual over that of the noise of the averaged record. \
             Gap: mean squared residual above the noise of the averaged record, over the variance of \
             the measured curve; means removed. A gap that stays far above the noise after a fit is a \
             sign of something the model lacks; this table says where to look, not what it is.",
        ]))
}

/// Describes the sector of the abscissa with the largest share of a channel's residual.
fn sector(along: &Abscissa, gap: &Gap) -> String {
    let (number, share) = gap.worst_sector();
    let (first, last) = match along.points.as_slice() {
        [first, .., last] => (*first, *last),
        _ => return MISSING.to_owned(),
    };
    let width = along.period.unwrap_or(last - first) / SECTORS as f64;
    let begin = first + number as f64 * width;
    let (begin, end) = (significant(begin), quantity(begin + width, &along.unit));
    format!("{begin} to {end}: {}", percent(share))
}

/// Describes the band of orders (multiples of the period's frequency) with the largest share of a periodic
/// channel's squared residual.
fn band(along: &Abscissa, gap: &Gap) -> String {
    if along.period.is_none() {
        return MISSING.to_owned();
    }
    let (orders, share) = gap.worst_band();
    let orders = match *orders.end() {
        usize::MAX => format!("from {}", orders.start()),
        end => format!("{} to {end}", orders.start()),
    };
    format!("{orders}: {}", percent(share))
}
