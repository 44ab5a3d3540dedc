//! Where the recalibrated simulation and the record part: crank angle, order, joint.
use crate::report::diagnosis::subject::{Subject, channels};
use crate::report::document::{Block, Figure, Section, figures};
use crate::report::number::{figure, fixed};
use crate::report::words::listed;
use crate::report::{chart, kind};
use discrepancy::place::along::Window;
use discrepancy::place::whereabouts::Where;
use discrepancy::record::Record;

/// Windows and entries that are named in words.
const NAMED: usize = 6;

pub(super) fn section(subject: &Subject<'_>) -> Section {
    let mut blocks = Vec::new();
    if let Some(seen) = &subject.diagnosis().whereabouts {
        let record = subject.calibrated();
        let names = record.map(channels).unwrap_or_default();
        blocks.push(Block::Text(
            "Everything here is what the recalibrated model, without any further effect, leaves of \
             the record; what another set of parameters could take up does not show."
                .to_owned(),
        ));
        blocks.extend(windows(seen, &names));
        blocks.push(Block::Text(peaks(seen, &names)));
        let maps = record.map(|record| maps(subject, seen, record));
        blocks.extend(figures(maps.into_iter().flatten()));
    }
    Section {
        id: "where",
        title: "Where the curves part",
        blocks,
    }
}

fn maps(subject: &Subject<'_>, seen: &Where, record: &Record) -> Vec<Figure> {
    let names = channels(record);
    let kind = kind::of(subject.case);
    let hertz = kind.and_then(|kind| kind.frequency_hz(subject.case, record.condition));
    let all = [
        chart::angle_map(&seen.along, &names),
        chart::order_map(&seen.order, &names, hertz),
        chart::joints(&seen.joints, seen.equivalent),
        chart::latent_forces(&seen.joints, seen.equivalent),
    ];
    all.into_iter().flatten().collect()
}

fn windows(seen: &Where, channels: &[String]) -> Vec<Block> {
    let all = &seen.along.windows;
    let item = |window: &Window| {
        format!(
            "{}, {} to {} deg: the simulation is too {} by {} standard deviations",
            channels.get(window.channel).map_or("", String::as_str),
            fixed(window.from, 0),
            fixed(end_deg(window), 0),
            if window.strength > 0.0 { "low" } else { "high" },
            fixed(window.strength.abs(), 1)
        )
    };
    if all.is_empty() {
        let none = "By crank angle: no window of the revolution stands out of the noise.";
        return vec![Block::Text(none.to_owned())];
    }
    let mut blocks = vec![
        Block::Text("By crank angle, the strongest first:".to_owned()),
        Block::List(all.iter().take(NAMED).map(item).collect()),
    ];
    if all.len() > NAMED {
        let more = format!("and {} more windows.", all.len() - NAMED);
        blocks.push(Block::Text(more));
    }
    blocks
}

/// Where a window ends, within the revolution.
fn end_deg(window: &Window) -> f64 {
    if window.to > 360.0 {
        window.to - 360.0
    } else {
        window.to
    }
}

fn peaks(seen: &Where, channels: &[String]) -> String {
    let all = &seen.order.peaks;
    if all.is_empty() {
        return "By order of the crank: no entry stands out of the noise.".to_owned();
    }
    let named = all.iter().take(NAMED).map(|peak| {
        let (order, ratio) = (peak.order, figure(peak.ratio));
        let channel = channels.get(peak.channel).map_or("", String::as_str);
        format!("order {order} at {channel} ({ratio}\u{a0}× noise)")
    });
    format!(
        "By order of the crank, {} entries stand out, most of all {}.",
        all.len(),
        listed(&named.collect::<Vec<_>>(), "and")
    )
}
