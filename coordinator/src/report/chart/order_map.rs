//! Channel x order of the crank: which coefficients of the residual are no noise.
use super::canvas::{Canvas, Lettering, render};
use super::panel::Panel;
use super::scale::Scale;
use super::{ChartError, Figure, GREY, INK, WIDTH};
use crate::report::color;
use crate::report::number::{figure, range};
use discrepancy::locate::order::OrderMap;
use plotters::prelude::RGBColor;
use plotters::style::text_anchor::{HPos, VPos};

const LEFT: f64 = 104.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 40.0;
const ROW: f64 = 30.0;
const FOOT: f64 = 46.0;
/// By how much cells overlap [px]: no seams between them.
const OVERLAP: f64 = 0.5;
/// The colour scale ends here at the earliest: noise stays pale.
const LEAST: f64 = 10.0;

/// Draws the map; rows are `channels`, in the map's order; `speed_rpm` turns orders into
/// frequencies. None of an empty map.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn order_map(
    map: &OrderMap,
    channels: &[String],
    speed_rpm: f64,
) -> Result<Option<Figure>, ChartError> {
    let orders = map.ratio.iter().map(Vec::len).max().unwrap_or(0);
    if orders == 0 || map.ratio.len() != channels.len() {
        return Ok(None);
    }
    let end = range(map.ratio.iter().flatten().copied()).map_or(LEAST, |(_, r)| r.max(LEAST));
    let height = TOP + ROW * channels.len() as f64 + FOOT;
    let title = "Residual over its uncertainty, by channel and order of the crank";
    let svg = render((WIDTH, height), title, |canvas| {
        let panel = Panel {
            left: LEFT,
            top: TOP,
            width: WIDTH - LEFT - RIGHT,
            height: ROW * channels.len() as f64,
            x: Scale::between(0.5, orders as f64 + 0.5, 8.0),
            y: Scale::between(channels.len() as f64, 0.0, 1.0),
        };
        key(canvas, end)?;
        for (row, ratios) in map.ratio.iter().enumerate() {
            let (top, bottom) = (panel.at_y(row as f64), panel.at_y(row as f64 + 1.0));
            for (k, ratio) in ratios.iter().enumerate() {
                let (from, to) = (panel.at_x(k as f64 + 0.5), panel.at_x(k as f64 + 1.5));
                canvas.rectangle(
                    (from, top),
                    ((to + OVERLAP).min(panel.right()), bottom),
                    color::pressure(share(*ratio, end)),
                )?;
            }
            let lettering = Lettering::new(11.0, INK).at(HPos::Right, VPos::Center);
            canvas.text(
                (LEFT - 10.0, 0.5 * (top + bottom)),
                &channels[row],
                lettering,
            )?;
        }
        for peak in &map.peaks {
            let at = panel.at((peak.order as f64, peak.channel as f64 + 0.5));
            canvas.dot(at, 1.9, mark(share(peak.ratio, end)))?;
        }
        let hertz = speed_rpm / 60.0;
        panel.lower_axis(
            canvas,
            true,
            &format!(
                "order of the crank (order 60 is {} Hz)",
                figure(60.0 * hertz)
            ),
        )
    })?;
    Ok(Some(Figure {
        name: "where_order".to_owned(),
        caption: format!(
            "{title}: power of the recalibrated model's residual over what noise would have there, on \
             a logarithmic scale. Dots: entries of which at most one in twenty is noise."
        ),
        svg,
    }))
}

/// Where a ratio lies on the colour scale: noise and less is paper.
fn share(ratio: f64, end: f64) -> f64 {
    if ratio > 1.0 {
        ratio.ln() / end.ln()
    } else {
        0.0
    }
}

/// Colour of a dot that is seen on its cell.
fn mark(share: f64) -> RGBColor {
    if share > 0.45 {
        RGBColor(0xff, 0xff, 0xff)
    } else {
        INK
    }
}

/// The colour scale above the map.
fn key(canvas: &Canvas<'_>, end: f64) -> Result<(), ChartError> {
    const BAR: f64 = 180.0;
    const STEPS: usize = 60;
    let y = 15.0;
    let left = WIDTH - RIGHT - BAR - 70.0;
    for step in 0..STEPS {
        let x = left + BAR * step as f64 / STEPS as f64;
        canvas.rectangle(
            (x, y - 5.0),
            (x + BAR / STEPS as f64 + OVERLAP, y + 5.0),
            color::pressure((step as f64 + 0.5) / STEPS as f64),
        )?;
    }
    let text = Lettering::new(10.5, GREY);
    let right = text.at(HPos::Right, VPos::Center);
    canvas.text((left - 8.0, y), "power over that of noise  1", right)?;
    canvas.text((left + BAR + 8.0, y), &figure(end), text)
}
