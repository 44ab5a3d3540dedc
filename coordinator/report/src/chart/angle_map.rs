//! Map of abscissa against channel that shows where along a record the residual is significant.
use super::axis::ChartAxis;
use super::canvas::{Canvas, Pen, WIDTH, render};
use super::panel::Panel;
use super::rows::{self, Key};
use crate::color::{Color, INK, SIGNED};
use crate::document::Figure;
use crate::number::{fixed, integer_or_significant, range, unit};
use crate::words::abscissa_quantity;
use discrepancy::localisation::window_test::{AbscissaWindow, AlongMap, Bins, WIDTHS};
use protocol::case::Abscissa;

/// Smallest value at the upper end of the map's colour scale (residual in standard deviations), so that noise
/// stays pale.
const LEAST: f64 = 5.0;

/// Draws the map of the residual over the abscissa, one row per name in `channels`, with the axis of the
/// first channel. Returns `None` for an empty map or if the channels have different abscissas.
pub(crate) fn angle_map(
    map: &AlongMap,
    channels: &[String],
    (abscissa, axis): (&Abscissa, &ChartAxis),
) -> Option<Figure> {
    let bins = map.bins.first()?;
    let rows = map.strength.len();
    if rows == 0 || rows != channels.len() || map.bins.iter().any(|other| other != bins) {
        return None;
    }
    let end =
        range(map.strength.iter().flatten().map(|s| s.abs())).map_or(LEAST, |(_, s)| s.max(LEAST));
    let height = rows::height(rows);
    let title = format!(
        "Residual over its uncertainty, by {} and channel",
        abscissa_quantity(abscissa)
    );
    let svg = render((WIDTH, height), &title, |canvas| {
        let panel = rows::panel(rows, axis.scale);
        let high = format!("simulated too high  −{}", fixed(end, 0));
        let low = format!("+{}  too low", fixed(end, 0));
        let key = Key {
            before: &high,
            behind: &low,
            room: 120.0,
        };
        rows::key(canvas, &SIGNED, &key);
        for (row, strengths) in map.strength.iter().enumerate() {
            let shares = strengths.iter().map(|strength| strength / end);
            cells(canvas, &panel, row, bins, shares);
        }
        for window in &map.windows {
            outline(canvas, &panel, bins, window);
        }
        rows::names(canvas, &panel, channels);
        panel.lower_axis(canvas, true, &axis.title);
    });
    Some(Figure {
        name: "where_angle".to_owned(),
        caption: format!(
            "{title}: mean of the recalibrated model's residual over {} {}, in its own standard \
             deviations; what a channel shares with the noise of those above it is taken out. Framed: \
             windows that noise alone would show in fewer than one record of twenty.",
            integer_or_significant(WIDTHS[0] as f64 * bins.width),
            unit(&abscissa.unit)
        ),
        svg,
    })
}

/// Draws one channel's row of the residual map: one coloured cell per abscissa bin, placed at the centre of
/// the averaging window that begins at the bin.
fn cells(
    canvas: &mut Canvas,
    panel: &Panel,
    row: usize,
    bins: &Bins,
    shares: impl Iterator<Item = f64>,
) {
    let (top, bottom) = (panel.at_y(row as f64), panel.at_y(row as f64 + 1.0));
    for (bin, share) in shares.enumerate() {
        // windows of what is not periodic all have their centres before the end
        let centre = (bin + WIDTHS[0] / 2) % bins.count;
        let from = panel.at_x(bins.begin(centre));
        let to = panel.at_x(bins.begin(centre + 1));
        canvas.rectangle(
            (from, top),
            ((to + rows::OVERLAP).min(panel.right()), bottom),
            deviation(share),
        );
    }
}

/// Returns the colour of a signed residual, given relative to the end of the colour scale (-1 to 1); neutral
/// if not finite.
fn deviation(share: f64) -> Color {
    let share = if share.is_finite() { share } else { 0.0 };
    SIGNED.at(0.5 + 0.5 * share)
}

/// Outlines a window of the abscissa in which the residual is significant; in two parts if the window extends
/// into the next period.
fn outline(canvas: &mut Canvas, panel: &Panel, bins: &Bins, window: &AbscissaWindow) {
    const INSET: f64 = 2.5;
    let pen = Pen::new(INK, 1.3);
    let top = panel.at_y(window.channel as f64) + INSET;
    let bottom = panel.at_y(window.channel as f64 + 1.0) - INSET;
    let (from, to) = (window.from, window.to);
    let (first, last) = (bins.begin(0), bins.begin(bins.count));
    let parts = if to > last {
        vec![(from, last), (first, first + to - last)]
    } else {
        vec![(from, to)]
    };
    for (from, to) in parts {
        let (left, right) = (panel.at_x(from), panel.at_x(to));
        canvas.line(&[(left, top), (right, top)], pen);
        canvas.line(&[(left, bottom), (right, bottom)], pen);
        // a part that goes on in the next period stays open there
        if from > first || window.from <= first {
            canvas.line(&[(left, top), (left, bottom)], pen);
        }
        if to < last || window.to <= last {
            canvas.line(&[(right, top), (right, bottom)], pen);
        }
    }
}
