//! Figure of the residual by channel and order (multiple of the period's frequency), which marks the
//! significant coefficients.
use super::canvas::{WIDTH, render};
use super::rows::{self, Key};
use super::scale::AxisScale;
use crate::color::{Color, INK, STRENGTH};
use crate::document::Figure;
use crate::number::{range, significant};
use discrepancy::localisation::order::OrderMap;

/// Smallest value at the upper end of the map's colour scale (power of the residual over its mean under
/// noise), so that noise stays pale.
const LEAST: f64 = 10.0;

/// Draws the map of the residual's power by order, one row per name in `channels`, in the map's order. Orders
/// are multiples of the frequency of the `period`, which is `hertz`. Returns `None` for an empty map.
pub(crate) fn order_map(
    map: &OrderMap,
    channels: &[String],
    (period, hertz): (&str, Option<f64>),
) -> Option<Figure> {
    let orders = map.ratio.iter().map(Vec::len).max().unwrap_or(0);
    if orders == 0 || map.ratio.len() != channels.len() {
        return None;
    }
    let end = range(map.ratio.iter().flatten().copied()).map_or(LEAST, |(_, r)| r.max(LEAST));
    let height = rows::height(channels.len());
    let title = format!("Residual over its uncertainty, by channel and order of the {period}");
    let svg = render((WIDTH, height), &title, |canvas| {
        let panel = rows::panel(
            channels.len(),
            AxisScale::between(0.5, orders as f64 + 0.5, 8.0),
        );
        let high = significant(end);
        let noise = "power over that of noise  1";
        let key = Key {
            before: noise,
            behind: &high,
            room: 70.0,
        };
        rows::key(canvas, &STRENGTH, &key);
        for (row, ratios) in map.ratio.iter().enumerate() {
            let (top, bottom) = (panel.at_y(row as f64), panel.at_y(row as f64 + 1.0));
            for (k, ratio) in ratios.iter().enumerate() {
                let (from, to) = (panel.at_x(k as f64 + 0.5), panel.at_x(k as f64 + 1.5));
                canvas.rectangle(
                    (from, top),
                    ((to + rows::OVERLAP).min(panel.right()), bottom),
                    STRENGTH.at(share(*ratio, end)),
                );
            }
        }
        rows::names(canvas, &panel, channels);
        for peak in &map.peaks {
            let at = panel.at((peak.order as f64, peak.channel as f64 + 0.5));
            canvas.dot(at, 1.9, mark(share(peak.ratio, end)));
        }
        let hertz = hertz.map(|hertz| format!(" (order 60 is {} Hz)", significant(60.0 * hertz)));
        let title = format!("order of the {period}{}", hertz.unwrap_or_default());
        panel.lower_axis(canvas, true, &title);
    });
    Some(Figure {
        name: "where_order".to_owned(),
        caption: format!(
            "{title}: power of the recalibrated model's residual over what noise would have there, on \
             a logarithmic scale. Dots: entries of which at most one in twenty is noise."
        ),
        svg,
    })
}

/// Returns the position of a power ratio on the logarithmic colour scale; 0 for ratios up to 1.
fn share(ratio: f64, end: f64) -> f64 {
    if ratio > 1.0 {
        ratio.ln() / end.ln()
    } else {
        0.0
    }
}

/// Returns the colour of the dot that marks a significant cell of the map, in contrast to the cell's own
/// colour; `share` is the cell's position on the colour scale.
fn mark(share: f64) -> Color {
    if share > 0.45 {
        Color(0xff, 0xff, 0xff)
    } else {
        INK
    }
}
