//! Report section that localises the residual of the recalibrated model: by abscissa, by order and by joint.
use crate::{
    chart::{self, ChartAxis},
    diagnosis::subject::{DiagnosisInput, channels},
    document::{Block, Figure, Section, figures},
    number::{fixed, integer_or_significant, significant, unit},
    words::{abscissa_quantity, join_words},
};
use discrepancy::localisation::summary::Localisation;
use discrepancy::localisation::window_test::AbscissaWindow;
use protocol::case::Abscissa;
use record::Record;

/// Maximum number of windows of the abscissa, and of residual peaks by order, listed in the text.
const NAMED: usize = 6;

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let mut blocks = Vec::new();
    if let Some(seen) = &subject.diagnosis().localisation {
        blocks.push(Block::Text(
            "Everything here is what the recalibrated model, without any further effect, leaves of \
             the record; what another set of parameters could take up does not show."
                .to_owned(),
        ));
        if let Some(record) = subject.calibrated() {
            blocks.extend(windows(seen, record));
            blocks.extend(peaks(seen, record).map(Block::Text));
            blocks.extend(figures(maps(subject, seen, record)));
        }
    }
    Section {
        id: "where",
        title: "Where the residual lies",
        blocks,
    }
}

fn maps(subject: &DiagnosisInput<'_>, seen: &Localisation, record: &Record) -> Vec<Figure> {
    let names = channels(record);
    let Some(first) = record.channels.first() else {
        return Vec::new();
    };
    let abscissa = &first.channel.abscissa;
    let axis = ChartAxis::of(subject.case, abscissa);
    let hertz = case::kind::of(subject.case).frequency_hz(subject.case, record.condition);
    let all = [
        chart::angle_map(&seen.along, &names, (abscissa, &axis)),
        chart::order_map(&seen.order, &names, (&abscissa.name, hertz)),
        chart::joints(&seen.joints, seen.equivalent),
        chart::latent_forces(&seen.joints, seen.equivalent, (abscissa, &axis)),
    ];
    all.into_iter().flatten().collect()
}

fn windows(seen: &Localisation, record: &Record) -> Vec<Block> {
    let all = &seen.along.windows;
    let item = |window: &AbscissaWindow| {
        let channel = record.channels.get(window.channel).map(|own| &own.channel);
        let channel = channel?;
        Some(format!(
            "{}, {} to {} {}: the simulation is too {} by {} standard deviations",
            channel.title,
            integer_or_significant(window.from),
            integer_or_significant(end(window, &channel.abscissa)),
            unit(&channel.abscissa.unit),
            if window.strength > 0.0 { "low" } else { "high" },
            fixed(window.strength.abs(), 1)
        ))
    };
    let first = record.channels.first();
    let by = first.map_or_else(String::new, |first| {
        abscissa_quantity(&first.channel.abscissa)
    });
    if all.is_empty() {
        let none = format!("By {by}: no window stands out of the noise.");
        return vec![Block::Text(none)];
    }
    let mut blocks = vec![
        Block::Text(format!("By {by}, the strongest first:")),
        Block::List(all.iter().take(NAMED).filter_map(item).collect()),
    ];
    if all.len() > NAMED {
        let more = format!("and {} more windows.", all.len() - NAMED);
        blocks.push(Block::Text(more));
    }
    blocks
}

/// Returns the upper end of a window of the abscissa, wrapped into the period.
fn end(window: &AbscissaWindow, abscissa: &Abscissa) -> f64 {
    let period = abscissa.period.filter(|period| window.to > *period);
    window.to - period.unwrap_or(0.0)
}

/// Describes the peaks of the residual by order (multiple of the period's frequency); `None` where no channel
/// is periodic.
fn peaks(seen: &Localisation, record: &Record) -> Option<String> {
    let mut abscissas = record.channels.iter().map(|own| &own.channel.abscissa);
    let of = &abscissas.find(|abscissa| abscissa.period.is_some())?.name;
    let all = &seen.order.peaks;
    if all.is_empty() {
        return Some(format!(
            "By order of the {of}: no entry stands out of the noise."
        ));
    }
    let named = all.iter().take(NAMED).map(|peak| {
        let (order, ratio) = (peak.order, significant(peak.ratio));
        let channel = record.channels.get(peak.channel);
        let channel = channel.map_or("", |own| own.channel.title.as_str());
        format!("order {order} at {channel} ({ratio}\u{a0}× noise)")
    });
    Some(format!(
        "By order of the {of}, {} entries stand out, most of all {}.",
        all.len(),
        join_words(&named.collect::<Vec<_>>(), "and")
    ))
}
