//! Derivatives of the channels over their abscissa, one strip for each name.
use super::axis::Axis;
use super::strip::{Curve, Strip, curve, stack, strip};
use crate::color::{BLUE, GREEN, INK, PURPLE, VERMILLION};
use crate::data::SingleRun;
use crate::document::Figure;
use crate::number::unit;
use crate::words::condition_name;
use protocol::case::Channel;
use protocol::job::Derivative;

/// Draws what has derivatives, one figure per unit of the channels; `zero` as [`Axis::of`] has it.
pub(crate) fn derivatives(run: &SingleRun, zero: &str) -> Vec<Figure> {
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
                &Axis::of(&kind.abscissa, zero),
                &strips,
            )
        })
    });
    figures.collect()
}

/// A strip for each name that changes some channel of a kind.
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
        let drawn: Vec<Curve> = drawn
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
