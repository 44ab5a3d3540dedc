//! Report section with measured and simulated curves, by condition and channel.
use crate::chart;
use crate::data::Calibration;
use crate::document::{Block, Section, figures};
use crate::words::condition_name;
use maud::html;

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let mut blocks = Vec::new();
    for result in &calibration.conditions {
        let overlays = chart::overlays(&calibration.case, result);
        if overlays.is_empty() {
            continue;
        }
        let name = condition_name(&calibration.case, result.condition);
        blocks.push(Block::Markup(html! { h3 { "Condition " (name) } }));
        blocks.extend(figures(overlays));
    }
    if !blocks.is_empty() {
        let order = html! { p { "Fitted points first, then the others of the record." } };
        blocks.insert(0, Block::Markup(order));
    }
    Section {
        id: "overlays",
        title: "Measured and simulated curves",
        blocks,
    }
}
