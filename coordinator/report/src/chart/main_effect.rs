//! Figure of the main effects of an orthogonal-array test of search settings: the mean response at every
//! level of every factor, side by side on one scale.
use super::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use super::panel::Panel;
use super::scale::AxisScale;
use crate::color::{BLUE, GREY, INK};
use crate::document::Figure;
use study::orthogonal::{Analysis, Factor, Range, TestResult};

const LEFT: f64 = 62.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 16.0;
const HEIGHT: f64 = 200.0;
const FOOT: f64 = 52.0;
const GAP: f64 = 18.0;

/// Draws the main effects of an orthogonal-array test: the mean response at every level of each factor.
pub(crate) fn main_effects(tested: &TestResult, analysis: &Analysis) -> Figure {
    let means = analysis
        .ranges
        .iter()
        .flat_map(|own| own.means.iter().copied());
    let y = AxisScale::linear(means, 6.0);
    let count = tested.factors.len().max(1) as f64;
    let width = (WIDTH - LEFT - RIGHT - GAP * (count - 1.0)) / count;
    let title = "Mean response at every level";
    let svg = render((WIDTH, TOP + HEIGHT + FOOT), title, |canvas| {
        let factors = tested.factors.iter().zip(&analysis.ranges);
        for (index, (factor, range)) in factors.enumerate() {
            let panel = Panel {
                left: LEFT + index as f64 * (width + GAP),
                top: TOP,
                width,
                height: HEIGHT,
                x: AxisScale::between(-0.5, factor.levels.len() as f64 - 0.5, 1.0),
                y,
            };
            draw(canvas, &panel, factor, range);
            if index == 0 {
                panel.left_axis(canvas, true, "log10 of the best objective");
            }
        }
    });
    Figure {
        name: "main_effects".to_owned(),
        caption: format!(
            "{title} of every factor, over all runs of that level; the smaller the better."
        ),
        svg,
    }
}

fn draw(canvas: &mut Canvas, panel: &Panel, factor: &Factor, range: &Range) {
    panel.guides(canvas);
    let points: Vec<(f64, f64)> = (0..)
        .zip(&range.means)
        .map(|(level, mean)| (f64::from(level), *mean))
        .collect();
    panel.curve(canvas, &points, Pen::new(BLUE, 1.4));
    for (point, level) in points.iter().zip(&factor.levels) {
        canvas.dot(panel.at(*point), 3.0, BLUE);
        let below = (panel.at_x(point.0), panel.bottom() + 8.0);
        canvas.text(below, level, TextStyle::new(10.5, INK).centered().below());
    }
    let middle = (panel.left + 0.5 * panel.width, panel.bottom() + 28.0);
    canvas.text(
        middle,
        &factor.name,
        TextStyle::new(10.5, GREY).centered().below(),
    );
}
