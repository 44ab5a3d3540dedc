//! Report section on the derivatives of the curves with respect to the unknowns: table and figures.
use crate::{
    chart::{
        ChartAxis,
        strip::{Strip, StripCurve, curve, stack, strip},
    },
    color::{BLUE, GREEN, INK, PURPLE, VERMILLION},
    data::SingleRun,
    document::{Block, Figure, Row, Section, Table, figures},
    number::{significant, unit},
    words::condition_name,
};
use protocol::case::Channel;
use protocol::job::{Derivative, Per};

pub(super) fn simulation(run: &SingleRun) -> Section {
    let mut blocks: Vec<Block> = derivatives(run).map(Block::Table).into_iter().collect();
    blocks.extend(figures(charts(run)));
    Section {
        id: "derivatives",
        title: "Derivatives",
        blocks,
    }
}

/// Builds the table of the derivatives of the curves: root mean square and largest value by unknown and
/// channel; `None` where no derivatives were requested.
pub fn derivatives(run: &SingleRun) -> Option<Table> {
    let channels = run.case.channels_of(run.condition);
    let channels: Vec<&Channel> = channels.map(|(_, channel)| channel).collect();
    let mut rows = Vec::new();
    for (at, name) in run.derived.iter().enumerate() {
        let said = |words: &str| Row::new(name.clone(), [words, "", "", ""].map(str::to_owned));
        match run.curves.columns.get(at) {
            Some(Derivative::Curves { per, curves }) => {
                let each = channels.iter().zip(curves);
                let each = each.filter(|(_, values)| !values.is_empty());
                rows.extend(each.map(|(channel, values)| row(name, channel, per, values)));
            }
            Some(Derivative::Nothing { .. }) => rows.push(said("changes nothing")),
            Some(Derivative::Missing { reason }) => rows.push(said(reason)),
            None => rows.push(said("none: the simulation did not complete")),
        }
    }
    let head = ["", "channel", "unit", "root mean square", "largest"];
    let table = Table::new("Derivatives of the curves", head, rows);
    let table = table.with_notes([
        "Exact for the curves as they were computed. Per decade of an unknown on a logarithmic scale, per \
         its unit elsewhere.",
    ]);
    table.non_empty()
}

fn row(name: &str, channel: &Channel, per: &Per, values: &[f32]) -> Row {
    let values = values.iter().map(|y| f64::from(*y));
    let square: f64 = values.clone().map(|y| y * y).sum();
    let rms = (square / values.len().max(1) as f64).sqrt();
    let largest = values.clone().fold(0.0, |most: f64, y| most.max(y.abs()));
    let unit = format!("{} per {per}", unit(&channel.unit));
    let cells = [
        channel.title.clone(),
        unit,
        significant(rms),
        significant(largest),
    ];
    Row::new(name, cells)
}

/// Draws the derivatives of the curves, one figure per unit and abscissa of the channels.
pub(crate) fn charts(run: &SingleRun) -> Vec<Figure> {
    let channels = run.case.channels_of(run.condition);
    let channels: Vec<&Channel> = channels.map(|(_, channel)| channel).collect();
    let mut kinds: Vec<&Channel> = Vec::new();
    for channel in &channels {
        let alike = |one: &&Channel| one.unit == channel.unit && one.abscissa == channel.abscissa;
        if !kinds.iter().any(alike) {
            kinds.push(channel);
        }
    }
    let condition = condition_name(&run.case, run.condition);
    let figures = kinds.into_iter().enumerate().filter_map(|(at, kind)| {
        let strips = strips(run, &channels, kind);
        (!strips.is_empty()).then(|| {
            stack(
                format!("derivatives_{condition}_{}", at + 1),
                &format!("Derivatives under condition {condition}"),
                format!(
                    "By how much the curves under condition {condition} change, to first order, when each \
                     of these grows alone."
                ),
                &ChartAxis::of(&run.case, &kind.abscissa),
                &strips,
            )
        })
    });
    figures.collect()
}

/// Builds one strip for each parameter that changes a channel with the unit and abscissa of `kind`.
fn strips(run: &SingleRun, channels: &[&Channel], kind: &Channel) -> Vec<Strip> {
    const COLORS: [crate::color::Color; 5] = [VERMILLION, BLUE, GREEN, PURPLE, INK];
    let named = run.derived.iter().zip(&run.curves.columns);
    let strips = named.filter_map(|(name, derivative)| {
        let Derivative::Curves { per, curves } = derivative else {
            return None;
        };
        let each = channels.iter().zip(curves);
        let own = each.filter(|(channel, values)| {
            channel.unit == kind.unit && channel.abscissa == kind.abscissa && !values.is_empty()
        });
        let drawn = own.zip(COLORS.iter().cycle());
        let drawn: Vec<StripCurve> = drawn
            .map(|((channel, values), color)| {
                let values: Vec<f64> = values.iter().map(|y| f64::from(*y)).collect();
                let points = &channel.abscissa.points;
                curve(&channel.title, *color, points, &values, 1.0)
            })
            .collect();
        let title = format!("{name} [{} per {per}]", unit(&kind.unit));
        (!drawn.is_empty()).then(|| strip(title, 110.0, drawn))
    });
    strips.collect()
}
