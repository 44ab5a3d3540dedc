//! Figure of a report's first screen: measured curves of few channels with the simulated ones before and after a
//! change of the model, side by side, and the residuals below.
use super::axis::ChartAxis;
use super::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use super::panel::Panel;
use super::points::points;
use super::scale::AxisScale;
use crate::color::{BAND, BLUE, INK, VERMILLION};
use crate::document::Figure;
use crate::words::with_unit;

const LEFT: f64 = 62.0;
const BETWEEN: f64 = 62.0;
const TOP: f64 = 44.0;
const HEIGHT: f64 = 190.0;
/// Height of the panel with the residuals.
const RESIDUAL: f64 = 76.0;
/// Distance between the panel with the curves and the one with the residuals below it.
const GAP: f64 = 14.0;
const ROW: f64 = HEIGHT + GAP + RESIDUAL + 66.0;
/// Number of panels beside each other.
const COLUMNS: usize = 2;

const MEASURED: Pen = Pen::new(INK, 1.4);
const BEFORE: Pen = Pen::new(BLUE, 0.9);
const AFTER: Pen = Pen::new(VERMILLION, 1.2);

/// Curves of one channel on the grid `at`.
pub(crate) struct BeforeAfter<'a> {
    /// Title of the channel, with its condition.
    pub title: String,
    /// Unit of the values.
    pub unit: String,
    /// Abscissa values.
    pub at: &'a [f64],
    /// Horizontal axis of the abscissa.
    pub axis: &'a ChartAxis,
    /// Measured mean.
    pub measured: &'a [f64],
    /// Standard deviation of one measured cycle; empty if it is unknown.
    pub spread: &'a [f64],
    /// Simulated curve before the change, shifted as it is compared.
    pub before: Vec<f64>,
    /// Simulated curve after the change, shifted as it is compared; `None` if nothing was changed.
    pub after: Option<Vec<f64>>,
}

/// Draws channels side by side; `labels` name the two simulated curves. `None` without channels.
pub(crate) fn before_after(
    channels: &[BeforeAfter<'_>],
    labels: [&str; 2],
    caption: String,
) -> Option<Figure> {
    if channels.is_empty() {
        return None;
    }
    let columns = channels.len().min(COLUMNS);
    let rows = channels.len().div_ceil(columns);
    let width = (WIDTH - LEFT - 10.0 - BETWEEN * (columns - 1) as f64) / columns as f64;
    let title = "Measured and simulated, before and after";
    let svg = render((WIDTH, 22.0 + rows as f64 * ROW), title, |canvas| {
        let changed = channels.iter().any(|channel| channel.after.is_some());
        key(canvas, labels, changed);
        for (index, channel) in channels.iter().enumerate() {
            let left = LEFT + (index % columns) as f64 * (width + BETWEEN);
            let top = TOP + (index / columns) as f64 * ROW;
            draw(canvas, channel, (left, top), width);
        }
    });
    Some(Figure {
        name: "before_after".to_owned(),
        caption,
        svg,
    })
}

fn draw(canvas: &mut Canvas, channel: &BeforeAfter<'_>, (left, top): (f64, f64), width: f64) {
    let rows = channel
        .at
        .iter()
        .zip(channel.measured.iter().zip(channel.spread));
    let band: Vec<_> = rows.map(|(&x, (m, s))| (x, m - s, m + s)).collect();
    let curves = [Some(&channel.before), channel.after.as_ref()];
    let simulated = curves.into_iter().flatten().flatten().copied();
    let edges = band.iter().flat_map(|&(_, low, high)| [low, high]);
    let values = simulated
        .chain(channel.measured.iter().copied())
        .chain(edges);
    let panel = Panel {
        left,
        top,
        width,
        height: HEIGHT,
        x: channel.axis.scale,
        y: AxisScale::linear(values, 5.0),
    };
    panel.guides(canvas);
    panel.band(canvas, &band, BAND);
    panel.curve(canvas, &points(channel.at, &channel.before), BEFORE);
    panel.curve(canvas, &points(channel.at, channel.measured), MEASURED);
    if let Some(after) = &channel.after {
        panel.curve(canvas, &points(channel.at, after), AFTER);
    }
    panel.left_axis(
        canvas,
        true,
        &with_unit("measured and simulated", &channel.unit),
    );
    panel.lower_axis(canvas, false, "");
    residuals(canvas, channel, (left, top + HEIGHT + GAP), width);
    let heading = TextStyle::new(12.0, INK).bold();
    canvas.text((left, top - 12.0), &channel.title, heading);
}

/// Draws measured minus simulated values, before and after, on one scale: curves that are close to the measured
/// one lie on each other above.
fn residuals(canvas: &mut Canvas, channel: &BeforeAfter<'_>, (left, top): (f64, f64), width: f64) {
    let residual = |simulated: &[f64]| -> Vec<f64> {
        let pairs = channel.measured.iter().zip(simulated);
        pairs.map(|(m, s)| m - s).collect()
    };
    let before = residual(&channel.before);
    let after = channel.after.as_deref().map(residual);
    let values = before.iter().chain(after.iter().flatten()).copied();
    let panel = Panel {
        left,
        top,
        width,
        height: RESIDUAL,
        x: channel.axis.scale,
        y: AxisScale::symmetric(values),
    };
    panel.guides(canvas);
    panel.curve(canvas, &points(channel.at, &before), BEFORE);
    if let Some(after) = &after {
        panel.curve(canvas, &points(channel.at, after), AFTER);
    }
    panel.left_axis(canvas, true, "residual");
    panel.lower_axis(canvas, true, &channel.axis.title);
}

/// Draws the legend above the panels.
fn key(canvas: &mut Canvas, [before, after]: [&str; 2], changed: bool) {
    let text = TextStyle::new(11.0, INK);
    let mut x = LEFT;
    let mut entry = |label: &str, pen: Pen| {
        canvas.line(&[(x, 10.0), (x + 24.0, 10.0)], pen);
        canvas.text((x + 30.0, 10.0), label, text);
        x += 52.0 + 6.6 * label.chars().count() as f64;
    };
    entry("measured", MEASURED);
    entry(before, BEFORE);
    if changed {
        entry(after, AFTER);
    }
}
