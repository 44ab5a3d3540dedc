//! Curves over the crank angle in strips one above the other on one axis: gauges, rope tensions,
//! motion of the suspension, crank torque.
use super::canvas::{Lettering, Pen, render};
use super::panel::{CRANK_TITLE, Panel, spread};
use super::scale::Scale;
use super::{BAND, BLUE, ChartError, Figure, GREEN, INK, PURPLE, VERMILLION, WIDTH, points};
use crate::report::words::condition_name;
use plotters::prelude::RGBColor;
use protocol::case::Case;
use protocol::job::Simulation;

const LEFT: f64 = 62.0;
const RIGHT: f64 = 96.0;
const TOP: f64 = 12.0;
const GAP: f64 = 16.0;
const FOOT: f64 = 44.0;

/// One curve with the label at its right end.
struct Curve {
    label: String,
    pen: Pen,
    points: Vec<(f64, f64)>,
}

/// One strip.
struct Strip {
    title: &'static str,
    height: f64,
    curves: Vec<Curve>,
    /// Rows of (crank angle, low, high) behind the curves.
    band: Vec<(f64, f64, f64)>,
}

fn curve(label: impl Into<String>, color: RGBColor, xs: &[f64], ys: &[f64], factor: f64) -> Curve {
    Curve {
        label: label.into(),
        pen: Pen { color, width: 1.2 },
        points: points(xs, ys)
            .into_iter()
            .map(|(x, y)| (x, factor * y))
            .collect(),
    }
}

fn strip(title: &'static str, height: f64, curves: Vec<Curve>) -> Strip {
    Strip {
        title,
        height,
        curves,
        band: Vec::new(),
    }
}

/// Draws the strips; with the pixel frame of the crank axis as data for a cursor.
fn stack(
    name: impl Into<String>,
    title: &str,
    caption: String,
    strips: &[Strip],
) -> Result<Figure, ChartError> {
    let heights: f64 = strips.iter().map(|strip| strip.height + GAP).sum();
    let height = TOP + heights - GAP + FOOT;
    let width = WIDTH - LEFT - RIGHT;
    let svg = render((WIDTH, height), title, |canvas| {
        let mut top = TOP;
        for (index, strip) in strips.iter().enumerate() {
            let curves = strip.curves.iter().flat_map(|curve| &curve.points);
            let band = strip.band.iter().flat_map(|&(_, low, high)| [low, high]);
            let panel = Panel {
                left: LEFT,
                top,
                width,
                height: strip.height,
                x: Scale::crank(),
                y: Scale::linear(
                    curves.map(|&(_, y)| y).chain(band),
                    (strip.height / 34.0).max(2.0),
                ),
            };
            panel.guides(canvas)?;
            panel.band(canvas, &strip.band, BAND)?;
            for curve in &strip.curves {
                panel.curve(canvas, &curve.points, curve.pen)?;
            }
            let ends: Vec<_> = strip
                .curves
                .iter()
                .map(|curve| {
                    let last = curve.points.iter().rfind(|(_, y)| y.is_finite());
                    last.map_or(panel.bottom(), |&(_, y)| panel.at_y(y))
                })
                .collect();
            let places = spread(&ends, 13.0, top, panel.bottom());
            for (curve, y) in strip.curves.iter().zip(places) {
                let lettering = Lettering::new(11.0, curve.pen.color);
                canvas.text((panel.right() + 7.0, y), &curve.label, lettering)?;
            }
            if strip.curves.iter().all(|curve| curve.points.len() < 2) {
                panel.remark(canvas, "nothing was simulated")?;
            }
            let last = index + 1 == strips.len();
            panel.left_axis(canvas, true, strip.title)?;
            panel.lower_axis(canvas, last, if last { CRANK_TITLE } else { "" })?;
            top = panel.bottom() + GAP;
        }
        Ok(())
    })?;
    Ok(Figure {
        name: name.into(),
        caption,
        svg,
    })
}

/// Stress at all four gauges, with the measured mean and its spread where there is a record.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn gauges(
    case: &Case,
    condition: usize,
    simulation: &Simulation,
) -> Result<Figure, ChartError> {
    let name = condition_name(case, condition);
    let record = case
        .conditions
        .get(condition)
        .and_then(|condition| condition.record.as_ref());
    let strips: Vec<_> = (1_u8..)
        .zip(&simulation.gauge_mpa)
        .map(|(gauge, stress)| {
            let trace = record.and_then(|record| {
                let trace = record.gauges.iter().find(|trace| trace.gauge == gauge)?;
                Some((record, trace))
            });
            let label = if trace.is_some() {
                "simulated".to_owned()
            } else {
                format!("gauge {gauge}")
            };
            let mut curves = vec![curve(label, VERMILLION, &simulation.turn_deg, stress, 1.0)];
            let mut band = Vec::new();
            if let Some((record, trace)) = trace {
                let measured = curve("measured", INK, &record.turn_deg, &trace.mean_mpa, 1.0);
                curves.insert(0, measured);
                let rows = trace.mean_mpa.iter().zip(&trace.spread_mpa);
                band = record
                    .turn_deg
                    .iter()
                    .zip(rows)
                    .map(|(&x, (&mean, &spread))| (x, mean - spread, mean + spread))
                    .collect();
            }
            Strip {
                title: [
                    "gauge 1 [MPa]",
                    "gauge 2 [MPa]",
                    "gauge 3 [MPa]",
                    "gauge 4 [MPa]",
                ][usize::from(gauge - 1)],
                height: 96.0,
                curves,
                band,
            }
        })
        .collect();
    stack(
        format!("gauges_{name}"),
        &format!("Stress at the gauges, condition {name}"),
        format!(
            "Stress at the four gauges under condition {name}, absolute values: no curve is \
             shifted here."
        ),
        &strips,
    )
}

/// Axial force of both ropes at their free ends.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn tension(simulation: &Simulation) -> Result<Figure, ChartError> {
    let turn = &simulation.turn_deg;
    let strips = [strip(
        "tension [kN]",
        150.0,
        vec![
            curve(
                "back rope",
                BLUE,
                turn,
                &simulation.back_rope_tension_n,
                1e-3,
            ),
            curve(
                "front rope",
                GREEN,
                turn,
                &simulation.front_rope_tension_n,
                1e-3,
            ),
        ],
    )];
    stack(
        "rope_tension",
        "Rope tension",
        "Axial force in the back rope at the crossbeam and in the front rope at the suspension."
            .to_owned(),
        &strips,
    )
}

/// Motion of the suspension point.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn motion(simulation: &Simulation) -> Result<Figure, ChartError> {
    let turn = &simulation.turn_deg;
    let strips = [
        strip(
            "height [m]",
            84.0,
            vec![curve("position", INK, turn, &simulation.suspension_m, 1.0)],
        ),
        strip(
            "velocity [m/s]",
            84.0,
            vec![curve(
                "velocity",
                INK,
                turn,
                &simulation.suspension_velocity_m_s,
                1.0,
            )],
        ),
        strip(
            "acceler. [m/s²]",
            84.0,
            vec![curve(
                "acceleration",
                INK,
                turn,
                &simulation.suspension_acceleration_m_s2,
                1.0,
            )],
        ),
    ];
    stack(
        "suspension",
        "Motion of the suspension point",
        "Position above the lowest design position, velocity and acceleration of the suspension \
         point, upwards positive."
            .to_owned(),
        &strips,
    )
}

/// Net torque at the crank shaft.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn torque(simulation: &Simulation) -> Result<Figure, ChartError> {
    let strips = [strip(
        "torque [kN m]",
        130.0,
        vec![curve(
            "net torque",
            PURPLE,
            &simulation.turn_deg,
            &simulation.crank_torque_n_m,
            1e-3,
        )],
    )];
    stack(
        "crank_torque",
        "Crank torque",
        "Net torque at the crank shaft, counterweight included; below zero the machine drives the \
         gear."
            .to_owned(),
        &strips,
    )
}

/// The strips beside the moving machine: stress at the objective's gauges, tension and torque.
/// Its crank axis runs from [`PLAYER_SPAN`]`.0` to `.1` [px].
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub(in crate::report) fn player(
    case: &Case,
    simulation: &Simulation,
) -> Result<Figure, ChartError> {
    let turn = &simulation.turn_deg;
    let colors = [VERMILLION, INK, GREEN, PURPLE];
    let stress = case
        .objective
        .gauges
        .iter()
        .filter_map(|&(gauge, _)| {
            let index = usize::from(gauge).checked_sub(1)?;
            let values = simulation.gauge_mpa.get(index)?;
            let label = format!("gauge {gauge}");
            Some(curve(label, colors[index % 4], turn, values, 1.0))
        })
        .collect();
    let strips = [
        strip("stress [MPa]", 104.0, stress),
        strip(
            "tension [kN]",
            84.0,
            vec![
                curve(
                    "back rope",
                    BLUE,
                    turn,
                    &simulation.back_rope_tension_n,
                    1e-3,
                ),
                curve(
                    "front rope",
                    GREEN,
                    turn,
                    &simulation.front_rope_tension_n,
                    1e-3,
                ),
            ],
        ),
        strip(
            "torque [kN m]",
            84.0,
            vec![curve(
                "crank",
                PURPLE,
                turn,
                &simulation.crank_torque_n_m,
                1e-3,
            )],
        ),
    ];
    stack(
        "player",
        "Curves beside the moving machine",
        "Simulated stress, rope tension and crank torque; the vertical line follows the machine."
            .to_owned(),
        &strips,
    )
}

/// Where the crank axis of [`player`] starts and ends, and its upper and lower edge, as shares of
/// the figure's width and height.
pub(in crate::report) const PLAYER_SPAN: [f64; 4] = {
    let height = TOP + 104.0 + 84.0 + 84.0 + 2.0 * GAP + FOOT;
    [
        LEFT / WIDTH,
        (WIDTH - RIGHT) / WIDTH,
        TOP / height,
        (height - FOOT) / height,
    ]
};
