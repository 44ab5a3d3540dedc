//! What the parameters leave unexplained, channel by channel.
use crate::report::data::{ConditionResult, Run};
use crate::report::document::{Row, Table};
use crate::report::number::{fixed, percent};
use crate::report::words::condition_name;
use discrepancy::proof::gap::{Gap, SECTOR_DEG};
use protocol::case::{Case, Channel, ChannelRecord};

/// The gap of both parameter sets under one condition, and where the optimised ones leave it;
/// nothing without a record or without a complete run.
pub(in crate::report) fn gap(case: &Case, result: &ConditionResult) -> Option<Table> {
    let [before, after] =
        [&result.recommended, &result.optimised].map(|run| gaps(case, result.condition, run));
    if after.is_empty() {
        return None;
    }
    let rows = after
        .iter()
        .map(|(channel, gap)| {
            let mut before = before.iter();
            let earlier = before.find(|(before, _)| before.name == channel.name);
            let (begin, of_sector) = gap.worst_sector();
            let (band, of_band) = gap.worst_band();
            Row::new(
                channel.title.as_str(),
                [
                    earlier.map_or_else(|| "–".to_owned(), |(_, gap)| percent(gap.share())),
                    percent(gap.share()),
                    gap.over_noise().map_or_else(
                        || "unknown".to_owned(),
                        |ratio| format!("{} ×", fixed(ratio, 1)),
                    ),
                    format!(
                        "{begin:.0} to {:.0} deg: {}",
                        begin + SECTOR_DEG,
                        percent(of_sector)
                    ),
                    format!("{band}: {}", percent(of_band)),
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
            "residual over noise",
            "worst sector",
            "worst band of crank orders",
        ], rows).noted([
            "Gap: mean squared residual above the noise of the averaged record, over the variance of \
             the measured curve; means removed. A gap that stays far above the noise after a fit is a \
             sign of something the model lacks; this table says where to look, not what it is.",
        ]))
}

/// Gaps of the measured channels.
fn gaps<'a>(case: &'a Case, condition: usize, run: &Run) -> Vec<(&'a Channel, Gap)> {
    let shown = run.shown(case, condition);
    let gap = |(_, channel, record): (usize, &'a Channel, &ChannelRecord)| {
        let gap = Gap::between(record, shown.channel(channel))?;
        Some((channel, gap))
    };
    case.measured(condition).filter_map(gap).collect()
}
