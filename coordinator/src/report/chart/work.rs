//! Error against work, one curve per method of integration: Newton iterations on the left, wall time
//! on the right.
use super::canvas::{Canvas, Lettering, Pen, render};
use super::panel::{Panel, spread};
use super::scale::Scale;
use super::{BLUE, ChartError, Figure, GREEN, GREY, INK, PURPLE, VERMILLION, WIDTH};
use crate::report::number::{duration, percent};
use crate::report::words::integrator_name;
use crate::study::{WorkPoint, WorkPrecision};
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};
use protocol::case::Integrator;

const HEIGHT: f64 = 400.0;
const TOP: f64 = 34.0;
const PANEL: f64 = 300.0;
const LEFT: f64 = 66.0;
const GAP: f64 = 40.0;
/// Room for the labels on the right.
const RIGHT: f64 = 150.0;
/// An error that serves a calibration: a hundredth of the range.
const WANTED: f64 = 0.01;

const fn color(integrator: Integrator) -> RGBColor {
    match integrator {
        Integrator::TrBdf2 => BLUE,
        Integrator::Esdirk4 => VERMILLION,
        Integrator::Rodas4 => GREEN,
        Integrator::GeneralizedAlpha => PURPLE,
        Integrator::Bdf => INK,
        Integrator::Bdf5 => GREY,
    }
}

/// What a panel shows along its lower axis.
struct Measure {
    title: &'static str,
    of: fn(&WorkPoint) -> f64,
}

const MEASURES: [Measure; 2] = [
    Measure {
        title: "Newton iterations",
        of: |point| point.counters.newton_iterations as f64,
    },
    Measure {
        title: "wall time [s]",
        of: |point| point.wall_s,
    },
];

/// Draws all methods: dots are runs, lines join those of a method that no other one beats.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn work_precision(all: &WorkPrecision) -> Result<Figure, ChartError> {
    let width = 0.5 * (WIDTH - LEFT - GAP - RIGHT);
    let errors = all.points.iter().filter_map(|point| point.error);
    let y = Scale::logarithmic(errors.map(|error| 100.0 * error).chain([100.0 * WANTED]));
    let title = "Error of the gauge curves against work, by method of integration";
    let svg = render((WIDTH, HEIGHT), title, |canvas| {
        for (index, measure) in MEASURES.iter().enumerate() {
            let complete = all.points.iter().filter(|point| point.error.is_some());
            let panel = Panel {
                left: LEFT + index as f64 * (width + GAP),
                top: TOP,
                width,
                height: PANEL,
                x: Scale::logarithmic(complete.map(measure.of)),
                y,
            };
            panel.guides(canvas)?;
            let wanted = panel.at_y(100.0 * WANTED);
            let pen = Pen {
                color: GREY,
                width: 0.8,
            };
            canvas.dashed((panel.left, wanted), (panel.right(), wanted), pen)?;
            curves(canvas, &panel, all, measure)?;
            let first = index == 0;
            panel.left_axis(canvas, first, if first { "error / range [%]" } else { "" })?;
            panel.lower_axis(canvas, true, measure.title)?;
            if !first {
                labels(canvas, &panel, all, measure)?;
            }
        }
        Ok(())
    })?;
    Ok(Figure {
        name: "integrators".to_owned(),
        caption: caption(title, all),
        svg,
    })
}

fn caption(title: &str, all: &WorkPrecision) -> String {
    let fixed = all.fixed.as_ref().map_or_else(String::new, |fixed| {
        format!(
            " A fixed step of {:e} s takes {} for {} steps.",
            fixed.longest_step_s,
            duration(fixed.wall_s),
            fixed.counters.steps
        )
    });
    format!(
        "{title}: root mean square difference to a converged run over the range of the worst gauge \
         (two converged runs of different methods are {} apart). Dots are runs, lines join those of \
         a method that none of its others beats; dashed, one per cent.{fixed}",
        percent_of(all.resolution)
    )
}

/// Small shares with the digits they have.
fn percent_of(share: f64) -> String {
    if share < 5e-4 {
        format!("{share:.1e}")
    } else {
        percent(share)
    }
}

fn curves(
    canvas: &Canvas<'_>,
    panel: &Panel,
    all: &WorkPrecision,
    measure: &Measure,
) -> Result<(), ChartError> {
    for point in &all.points {
        if let Some(error) = point.error {
            let at = panel.at(((measure.of)(point), 100.0 * error));
            canvas.dot(at, 2.2, color(point.integrator))?;
        }
    }
    for integrator in Integrator::ALL {
        let front = all.front(integrator, measure.of);
        let front: Vec<(f64, f64)> = front.iter().map(|&(x, y)| (x, 100.0 * y)).collect();
        let pen = Pen {
            color: color(integrator),
            width: 1.5,
        };
        panel.curve(canvas, &front, pen)?;
    }
    Ok(())
}

/// Names at the right edge, at the height of each method's most accurate run.
fn labels(
    canvas: &Canvas<'_>,
    panel: &Panel,
    all: &WorkPrecision,
    measure: &Measure,
) -> Result<(), ChartError> {
    let named: Vec<(Integrator, f64)> = Integrator::ALL
        .into_iter()
        .filter_map(|integrator| {
            let (_, error) = *all.front(integrator, measure.of).last()?;
            Some((integrator, panel.at_y(100.0 * error)))
        })
        .collect();
    let wanted: Vec<f64> = named.iter().map(|&(_, y)| y).collect();
    let places = spread(&wanted, 14.0, panel.top, panel.bottom());
    for ((integrator, _), y) in named.iter().zip(places) {
        let lettering = Lettering::new(11.0, color(*integrator)).at(HPos::Left, VPos::Center);
        canvas.text(
            (panel.right() + 8.0, y),
            integrator_name(*integrator),
            lettering,
        )?;
    }
    Ok(())
}
