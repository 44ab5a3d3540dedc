//! Figures of the crank's balance: torque and power with the present and the best counterweight, and the effect of its
//! moment and phase as a map.
use super::revolution::axis;
use crate::chart::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use crate::chart::strip::{StripCurve, curve, stack, strip};
use crate::color::{AXIS, BLUE, GREY, INK, PURPLE, STRENGTH, VERMILLION};
use crate::document::Figure;
use crate::number::fixed;

/// Factor from newton metres and watts to the units of the figures.
const KILO: f64 = 1e-3;
/// Height of a strip of torque [px], and of one of power.
const HEIGHTS: [f64; 2] = [150.0, 90.0];
/// Margins of the map [px]: left, top, right, bottom.
const MARGINS: [f64; 4] = [70.0, 28.0, 150.0, 48.0];
/// Height of the map's area [px].
const MAP_HEIGHT: f64 = 250.0;

/// Input data of the figures of the crank's balance.
#[derive(Clone, Debug)]
pub struct CrankBalancePicture<'a> {
    /// Rated torque of the reducer [N m]; `None` where it is not known.
    pub rating_n_m: Option<f64>,
    /// Conditions of the operation.
    pub conditions: Vec<CrankTorque<'a>>,
    /// Effect of moment and phase.
    pub map: BalanceMap,
}

/// Torque of the crank over one revolution.
#[derive(Clone, Debug)]
pub struct CrankTorque<'a> {
    /// Name of the condition.
    pub name: &'a str,
    /// Crank speed [rad/s].
    pub speed: f64,
    /// Crank angles and net torque with the present counterweight \[deg\], [N m].
    pub present: (&'a [f64], &'a [f64]),
    /// Crank angles and net torque with the best counterweight \[deg\], [N m].
    pub best: (&'a [f64], &'a [f64]),
    /// Crank angles and measured torque \[deg\], [N m]; `None` where it was not measured.
    pub measured: Option<(&'a [f64], &'a [f64])>,
}

/// Goal of the balance over moment and phase of the counterweight.
#[derive(Clone, Debug)]
pub struct BalanceMap {
    /// Name of the goal, such as `peak torque`.
    pub goal: &'static str,
    /// Moments [N m], in ascending order.
    pub moments_n_m: Vec<f64>,
    /// Phases \[deg\], in ascending order.
    pub phases_deg: Vec<f64>,
    /// Goal at each phase, by moment [N m].
    pub values_n_m: Vec<Vec<f64>>,
    /// Moment and phase of the present counterweights [N m], \[deg\].
    pub present: Vec<(f64, f64)>,
    /// Moment and phase of the best counterweight [N m], \[deg\].
    pub best: (f64, f64),
}

/// Draws torque and power with the present and the best counterweight, and the map of moment and phase.
pub fn crank_balance(picture: &CrankBalancePicture<'_>) -> Vec<Figure> {
    let mut figures: Vec<Figure> = picture
        .conditions
        .iter()
        .map(|own| torque(own, picture.rating_n_m))
        .collect();
    figures.push(map(&picture.map));
    figures
}

fn torque(of: &CrankTorque<'_>, rating_n_m: Option<f64>) -> Figure {
    let lines = |factor: f64| -> Vec<StripCurve> {
        vec![
            curve("present", PURPLE, of.present.0, of.present.1, factor),
            curve("best", BLUE, of.best.0, of.best.1, factor),
        ]
    };
    let mut torques = lines(KILO);
    if let Some((turn, torque)) = of.measured {
        torques.insert(0, curve("measured", INK, turn, torque, KILO));
    }
    if let Some(rating) = rating_n_m {
        torques.push(curve(
            "rating",
            VERMILLION,
            &[0.0, 360.0],
            &[rating; 2],
            KILO,
        ));
    }
    let strips = [
        strip("torque [kN m]", HEIGHTS[0], torques),
        strip("power [kW]", HEIGHTS[1], lines(KILO * of.speed)),
    ];
    stack(
        format!("crank_balance_{}", of.name),
        &format!("Torque and power of the crank, condition {}", of.name),
        format!(
            "Net torque at the crank shaft and its power under condition {}, with the present and the best counterweight, \
             simulated; below zero the machine drives the gear.",
            of.name
        ),
        &axis(),
        &strips,
    )
}

/// Draws the goal over moment and phase, darker where it is larger.
fn map(map: &BalanceMap) -> Figure {
    let [left, top, right, bottom] = MARGINS;
    let (width, height) = (WIDTH - left - right, MAP_HEIGHT);
    let ends = |values: &[f64]| [values[0], values[values.len() - 1]];
    let (moments, phases) = (ends(&map.moments_n_m), ends(&map.phases_deg));
    let x = |moment: f64| left + width * (moment - moments[0]) / (moments[1] - moments[0]);
    let y = |phase: f64| top + height * (phases[1] - phase) / (phases[1] - phases[0]);
    let all = || map.values_n_m.iter().flatten().copied();
    let (low, high) = (
        all().fold(f64::INFINITY, f64::min),
        all().fold(f64::NEG_INFINITY, f64::max),
    );
    let title = format!("{} by moment and phase of the counterweight", map.goal);
    let svg = render((WIDTH, top + height + bottom), &title, |canvas| {
        let cell = (
            width / map.moments_n_m.len() as f64,
            height / map.phases_deg.len() as f64,
        );
        for (row, values) in map.values_n_m.iter().rev().enumerate() {
            for (column, value) in values.iter().enumerate() {
                let from = (left + column as f64 * cell.0, top + row as f64 * cell.1);
                let to = (from.0 + cell.0 + 0.5, from.1 + cell.1 + 0.5);
                canvas.rectangle(from, to, STRENGTH.at((value - low) / (high - low)));
            }
        }
        let corners = [
            (left, top),
            (left, top + height),
            (left + width, top + height),
        ];
        canvas.line(&corners, Pen::new(AXIS, 1.0));
        for k in 0..=4 {
            let part = f64::from(k) / 4.0;
            let moment = moments[0] + part * (moments[1] - moments[0]);
            let lettering = TextStyle::new(11.0, GREY).centered().below();
            let at = (x(moment), top + height + 4.0);
            canvas.text(at, &fixed(KILO * moment, 0), lettering);
            let phase = phases[0] + part * (phases[1] - phases[0]);
            let lettering = TextStyle::new(11.0, GREY).right();
            canvas.text((left - 6.0, y(phase)), &fixed(phase, 1), lettering);
        }
        let lettering = TextStyle::new(11.0, INK).centered().below();
        let foot = (left + 0.5 * width, top + height + 22.0);
        canvas.text(foot, "moment [kN m]", lettering);
        let head = (left - 56.0, top - 14.0);
        canvas.text(head, "phase [deg]", TextStyle::new(11.0, INK));
        for (moment, phase) in &map.present {
            mark(
                canvas,
                (x(*moment), y(*phase)),
                "present",
                *moment <= map.best.0,
            );
        }
        let first = map.present.first().map_or(f64::NEG_INFINITY, |own| own.0);
        mark(
            canvas,
            (x(map.best.0), y(map.best.1)),
            "best",
            map.best.0 < first,
        );
        legend(canvas, (left + width + 16.0, top), (low, high), map.goal);
    });
    Figure {
        name: "counterweight_map".to_owned(),
        caption: format!(
            "{} with each moment of the counterweight and each phase ahead of the crank pin, over all conditions of the \
             operation.",
            capital(map.goal)
        ),
        svg,
    }
}

/// Marks a counterweight, with its label on the left or on the right.
fn mark(canvas: &mut Canvas, at: (f64, f64), label: &str, on_the_left: bool) {
    canvas.dot(at, 4.0, INK);
    let lettering = TextStyle::new(11.0, INK).bold();
    if on_the_left {
        canvas.text((at.0 - 7.0, at.1), label, lettering.right());
    } else {
        canvas.text((at.0 + 7.0, at.1), label, lettering);
    }
}

/// Draws the scale of the map's shades.
fn legend(canvas: &mut Canvas, (left, top): (f64, f64), (low, high): (f64, f64), goal: &str) {
    canvas.text((left, top), goal, TextStyle::new(11.0, INK));
    canvas.text((left, top + 15.0), "[kN m]", TextStyle::new(11.0, INK));
    for k in 0..=4 {
        let share = 1.0 - f64::from(k) / 4.0;
        let at = top + 36.0 + 20.0 * f64::from(k);
        canvas.rectangle(
            (left, at - 8.0),
            (left + 16.0, at + 8.0),
            STRENGTH.at(share),
        );
        let value = KILO * (low + share * (high - low));
        canvas.text(
            (left + 22.0, at),
            &fixed(value, 1),
            TextStyle::new(11.0, GREY),
        );
    }
}

/// Returns a text with its first letter in upper case.
fn capital(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the darkest cell of a map is the largest value, that the present and the best counterweight are
    /// marked, and that a rating is drawn where there is one.
    #[test]
    fn a_map_has_its_extremes_and_both_marks() {
        let turn = [0.0, 180.0, 360.0];
        let torque = [1e3, 3e4, 1e3];
        let picture = CrankBalancePicture {
            rating_n_m: Some(37e3),
            conditions: vec![CrankTorque {
                name: "5rpm",
                speed: 0.5,
                present: (&turn, &torque),
                best: (&turn, &torque),
                measured: None,
            }],
            map: BalanceMap {
                goal: "peak torque",
                moments_n_m: vec![9e4, 1e5],
                phases_deg: vec![-5.0, 5.0],
                values_n_m: vec![vec![30e3, 20e3], vec![25e3, 40e3]],
                present: vec![(9.2e4, 0.0)],
                best: (9.9e4, -4.0),
            },
        };
        let [torque, map] = crank_balance(&picture).try_into().unwrap();
        assert!(torque.svg.contains("rating") && !torque.svg.contains("measured"));
        for text in ["present", "best", "40.0", "20.0"] {
            assert!(map.svg.contains(text), "{text}");
        }
        let unrated = CrankBalancePicture {
            rating_n_m: None,
            ..picture
        };
        assert!(!crank_balance(&unrated)[0].svg.contains("rating"));
    }
}
