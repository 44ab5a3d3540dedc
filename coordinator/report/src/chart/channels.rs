//! Figures of one simulation's channels in stacked strips, in absolute values, with the measured mean and
//! spread where recorded.
use super::{
    axis::ChartAxis,
    strip::{Strip, curve, stack, strip},
};
use crate::{
    color::{INK, VERMILLION},
    data::SimulationView,
    document::Figure,
    number::unit,
    words::condition_name,
};
use protocol::case::Channel;

/// Draws all channels of a simulation, one figure per abscissa name.
pub fn channels(of: &SimulationView<'_>) -> Vec<Figure> {
    let all = of.case.channels_of(of.condition);
    let mut kinds: Vec<&Channel> = all.map(|(_, channel)| channel).collect();
    kinds.dedup_by(|one, other| one.abscissa.name == other.abscissa.name);
    let condition = condition_name(of.case, of.condition);
    let figure = |kind: &Channel| {
        let over = &kind.abscissa.name;
        stack(
            format!("curves_{condition}_{over}"),
            &format!("Curves over the {over}, condition {condition}"),
            format!(
                "Simulated curves under condition {condition}, absolute values: no curve is shifted here."
            ),
            &ChartAxis::of(of.case, &kind.abscissa),
            &strips(of, |channel| channel.abscissa.name == *over),
        )
    };
    kinds.into_iter().map(figure).collect()
}

/// Builds a strip of curves for every channel of a simulation that `wanted` selects.
pub fn strips(of: &SimulationView<'_>, wanted: impl Fn(&Channel) -> bool) -> Vec<Strip> {
    let all = of.case.channels_of(of.condition);
    all.filter(|(_, channel)| wanted(channel))
        .map(|(_, channel)| one(channel, of.channel(channel)))
        .collect()
}

fn one(channel: &Channel, simulated: &[f64]) -> Strip {
    let grid = &channel.abscissa.points;
    let title = format!("{} [{}]", channel.title, unit(&channel.unit));
    let Some(record) = &channel.record else {
        let alone = curve(&channel.title, VERMILLION, grid, simulated, 1.0);
        return strip(title, 96.0, vec![alone]);
    };
    let rows = grid.iter().zip(record.mean.iter().zip(&record.spread));
    Strip {
        band: rows
            .map(|(&x, (&mean, &spread))| (x, mean - spread, mean + spread))
            .collect(),
        ..strip(
            title,
            96.0,
            vec![
                curve("measured", INK, grid, &record.mean, 1.0),
                curve("simulated", VERMILLION, grid, simulated, 1.0),
            ],
        )
    }
}
