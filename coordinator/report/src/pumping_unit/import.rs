//! Pictures of an import: all turns of a record over each other, and a load card over the crank angle.
use crate::chart::{
    ChartAxis,
    scale::AxisScale,
    strip::{Strip, StripCurve, curve, stack, strip},
};
use crate::color::{INK, STRENGTH, VERMILLION};
use crate::document::Figure;
use crate::number::unit;
use protocol::case::Channel;

/// Largest number of turns in a picture; of more, equally spaced ones are drawn.
const MOST: usize = 40;

/// Draws the turns of a record over each other, one strip per channel, from pale for the first turn to dark
/// for the last; `cycles` has the curves of each turn in the order of the channels.
pub fn turns(turn_deg: &[f64], channels: &[Channel], cycles: &[Vec<Vec<f64>>]) -> Figure {
    let last = cycles.len().saturating_sub(1);
    let every = cycles.len().div_ceil(MOST).max(1);
    let of = |(place, channel): (usize, &Channel)| -> Strip {
        let (factor, shown) = match channel.unit.as_str() {
            "N.m" => (1e-3, "kN.m"),
            shown => (1.0, shown),
        };
        let turn = |(number, cycle): (usize, &Vec<Vec<f64>>)| -> Option<StripCurve> {
            let label = if number == 0 || number == last {
                format!("turn {}", number + 1)
            } else {
                String::new()
            };
            let shade = 0.35 + 0.65 * number as f64 / last.max(1) as f64;
            Some(curve(
                label,
                STRENGTH.at(shade),
                turn_deg,
                cycle.get(place)?,
                factor,
            ))
        };
        strip(
            format!("{} [{}]", channel.title, unit(shown)),
            130.0,
            cycles
                .iter()
                .enumerate()
                .filter(|(number, _)| number % every == 0 || *number == last)
                .filter_map(turn)
                .collect(),
        )
    };
    let strips: Vec<Strip> = channels.iter().enumerate().map(of).collect();
    stack(
        "turns",
        "Turns of the record over each other",
        format!(
            "{} turns of the crank over each other, as recorded, before anything is fitted.",
            cycles.len()
        ),
        &axis(),
        &strips,
    )
}

/// Draws a load card over the crank angle, and the position of its points beside that of the kinematics.
pub fn imported_card(
    turn_deg: &[f64],
    load_n: &[f64],
    position_m: &[f64],
    expected_m: &[f64],
) -> Figure {
    let strips = [
        strip(
            "load [kN]",
            160.0,
            vec![curve("load", INK, turn_deg, load_n, 1e-3)],
        ),
        strip(
            "position [m]",
            130.0,
            vec![
                curve("card", INK, turn_deg, position_m, 1.0),
                curve("kinematics", VERMILLION, turn_deg, expected_m, 1.0),
            ],
        ),
    ];
    stack(
        "card",
        "Load card over the crank angle",
        "Points of the card over the crank angle, and the position by the kinematics of the case."
            .to_owned(),
        &axis(),
        &strips,
    )
}

fn axis() -> ChartAxis {
    ChartAxis {
        scale: AxisScale::turn(),
        title: "crank angle from bottom dead centre [\u{b0}]".to_owned(),
    }
}
