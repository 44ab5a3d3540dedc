//! Curves over the crank angle in strips one above the other on one axis, labelled at their right
//! ends. What is drawn in them is not known here.
use super::canvas::{Lettering, Pen, WIDTH, render};
use super::panel::{CRANK_TITLE, Panel, spread};
use super::points::points;
use super::scale::Scale;
use crate::report::color::{BAND, Color};
use crate::report::document::Figure;

const LEFT: f64 = 62.0;
const RIGHT: f64 = 96.0;
const TOP: f64 = 12.0;
const GAP: f64 = 16.0;
const FOOT: f64 = 44.0;

/// One curve with the label at its right end.
pub(crate) struct Curve {
    label: String,
    color: Color,
    points: Vec<(f64, f64)>,
}

/// One strip.
pub(crate) struct Strip<'a> {
    /// Title of its scale, with the unit.
    pub title: &'a str,
    /// Height [px].
    pub height: f64,
    /// Curves, drawn in this order.
    pub curves: Vec<Curve>,
    /// Rows of (crank angle, low, high) behind the curves.
    pub band: Vec<(f64, f64, f64)>,
    /// Its scale, where it is not the curves' own.
    pub scale: Option<Scale>,
}

/// A curve over the crank angle, its values times a factor.
pub(crate) fn curve(
    label: impl Into<String>,
    color: Color,
    turn_deg: &[f64],
    values: &[f64],
    factor: f64,
) -> Curve {
    Curve {
        label: label.into(),
        color,
        points: points(turn_deg, values)
            .into_iter()
            .map(|(x, y)| (x, factor * y))
            .collect(),
    }
}

/// A strip without a band.
pub(crate) const fn strip(title: &str, height: f64, curves: Vec<Curve>) -> Strip<'_> {
    Strip {
        title,
        height,
        curves,
        band: Vec::new(),
        scale: None,
    }
}

/// Height of the whole figure [px].
fn height(strips: &[Strip<'_>]) -> f64 {
    let heights: f64 = strips.iter().map(|strip| strip.height + GAP).sum();
    TOP + heights - GAP + FOOT
}

/// Left, right, upper and lower end of the crank axis, as shares of the figure's width and height:
/// the place for a cursor.
pub(crate) fn span(strips: &[Strip<'_>]) -> [f64; 4] {
    let height = height(strips);
    [
        LEFT / WIDTH,
        (WIDTH - RIGHT) / WIDTH,
        TOP / height,
        (height - FOOT) / height,
    ]
}

/// Draws the strips.
pub(crate) fn stack(
    name: impl Into<String>,
    title: &str,
    caption: String,
    strips: &[Strip<'_>],
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
                x: Scale::crank(),
                y: strip.scale.unwrap_or_else(|| {
                    Scale::linear(
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
                let lettering = Lettering::new(11.0, curve.color);
                canvas.text((panel.right() + 7.0, y), &curve.label, lettering);
            }
            if strip.curves.iter().all(|curve| curve.points.len() < 2) {
                panel.remark(canvas, "nothing was simulated");
            }
            let last = index + 1 == strips.len();
            panel.left_axis(canvas, true, strip.title);
            panel.lower_axis(canvas, last, if last { CRANK_TITLE } else { "" });
            top = panel.bottom() + GAP;
        }
    });
    Figure {
        name: name.into(),
        caption,
        svg,
    }
}
