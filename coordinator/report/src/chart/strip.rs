//! Stacked panels ("strips") of curves over one shared abscissa, with labels at the right ends of the curves.
//! Independent of the quantities drawn.
use super::axis::ChartAxis;
use super::canvas::{Pen, TextStyle, WIDTH, render};
use super::panel::{Panel, spread};
use super::points::points;
use super::scale::AxisScale;
use crate::color::{BAND, Color};
use crate::document::Figure;

const LEFT: f64 = 62.0;
const RIGHT: f64 = 96.0;
const TOP: f64 = 12.0;
const GAP: f64 = 16.0;
const FOOT: f64 = 44.0;

/// Curve of a strip, with a label at its right end unless that is empty.
pub struct StripCurve {
    label: String,
    color: Color,
    points: Vec<(f64, f64)>,
}

/// Panel of one or several curves in a stack of panels with a common horizontal axis.
pub struct Strip {
    /// Title of the vertical axis, with the unit.
    pub title: String,
    /// Height of the strip \[px\].
    pub height: f64,
    /// Curves of the strip, in drawing order.
    pub curves: Vec<StripCurve>,
    /// Band drawn behind the curves of the strip, as points (abscissa, lower end, upper end).
    pub band: Vec<(f64, f64, f64)>,
    /// Vertical scale of the strip; `None` to derive it from the curves.
    pub scale: Option<AxisScale>,
}

/// Builds a labelled curve of a strip from values, each multiplied by a factor such as a unit conversion.
pub fn curve(
    label: impl Into<String>,
    color: Color,
    at: &[f64],
    values: &[f64],
    factor: f64,
) -> StripCurve {
    StripCurve {
        label: label.into(),
        color,
        points: points(at, values)
            .into_iter()
            .map(|(x, y)| (x, factor * y))
            .collect(),
    }
}

/// Builds a strip without a band.
pub fn strip(title: impl Into<String>, height: f64, curves: Vec<StripCurve>) -> Strip {
    Strip {
        title: title.into(),
        height,
        curves,
        band: Vec::new(),
        scale: None,
    }
}

/// Returns the height of the figure in which the strips are stacked [px].
fn height(strips: &[Strip]) -> f64 {
    let heights: f64 = strips.iter().map(|strip| strip.height + GAP).sum();
    TOP + heights - GAP + FOOT
}

/// Returns the left, right, upper and lower ends of the plot area as shares of the figure's width and height,
/// for placing a cursor over it.
pub fn span(strips: &[Strip]) -> [f64; 4] {
    let height = height(strips);
    [
        LEFT / WIDTH,
        (WIDTH - RIGHT) / WIDTH,
        TOP / height,
        (height - FOOT) / height,
    ]
}

/// Draws the strips one above the other on a common axis.
pub fn stack(
    name: impl Into<String>,
    title: &str,
    caption: String,
    axis: &ChartAxis,
    strips: &[Strip],
) -> Figure {
    let width = WIDTH - LEFT - RIGHT;
    let svg = render((WIDTH, height(strips)), title, |canvas| {
        let mut top = TOP;
        for (index, strip) in strips.iter().enumerate() {
            let curves = strip.curves.iter().flat_map(|curve| &curve.points);
            let band = strip.band.iter().flat_map(|&(_, low, high)| [low, high]);
            let panel = Panel {
                left: LEFT,
                top,
                width,
                height: strip.height,
                x: axis.scale,
                y: strip.scale.unwrap_or_else(|| {
                    AxisScale::linear(
                        curves.map(|&(_, y)| y).chain(band),
                        (strip.height / 26.0).max(2.0),
                    )
                }),
            };
            panel.guides(canvas);
            panel.band(canvas, &strip.band, BAND);
            for curve in &strip.curves {
                panel.curve(canvas, &curve.points, Pen::new(curve.color, 1.2));
            }
            let labelled = || strip.curves.iter().filter(|curve| !curve.label.is_empty());
            let ends: Vec<_> = labelled()
                .map(|curve| {
                    let last = curve.points.iter().rfind(|(_, y)| y.is_finite());
                    last.map_or(panel.bottom(), |&(_, y)| panel.at_y(y))
                })
                .collect();
            let places = spread(&ends, 13.0, top, panel.bottom());
            for (curve, y) in labelled().zip(places) {
                let lettering = TextStyle::new(11.0, curve.color);
                canvas.text((panel.right() + 7.0, y), &curve.label, lettering);
            }
            if strip.curves.iter().all(|curve| curve.points.len() < 2) {
                panel.remark(canvas, "no simulated curve");
            }
            let last = index + 1 == strips.len();
            panel.left_axis(canvas, true, &strip.title);
            panel.lower_axis(canvas, last, if last { &axis.title } else { "" });
            top = panel.bottom() + GAP;
        }
    });
    Figure {
        name: name.into(),
        caption,
        svg,
    }
}
