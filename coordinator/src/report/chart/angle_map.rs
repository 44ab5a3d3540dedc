//! Crank angle x channel: where in the revolution the residual is no noise.
use super::canvas::{Canvas, Lettering, Pen, render};
use super::panel::{CRANK_TITLE, Panel};
use super::scale::Scale;
use super::{ChartError, Figure, GREY, INK, WIDTH};
use crate::report::color;
use crate::report::number::{fixed, range};
use discrepancy::locate::angle::{AngleMap, BINS, WIDTHS, Window};
use plotters::style::text_anchor::{HPos, VPos};

const LEFT: f64 = 104.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 40.0;
const ROW: f64 = 30.0;
const FOOT: f64 = 46.0;
/// By how much cells overlap [px]: no seams between them.
const OVERLAP: f64 = 0.5;
/// The colour scale ends here at the earliest (standard deviations): noise stays pale.
const LEAST: f64 = 5.0;

/// Draws the map; rows are `channels`, in the map's order. None of an empty map.
///
/// # Errors
/// [`ChartError`] when the drawing library fails.
pub fn angle_map(map: &AngleMap, channels: &[String]) -> Result<Option<Figure>, ChartError> {
    if map.strength.is_empty() || map.strength.len() != channels.len() {
        return Ok(None);
    }
    let end =
        range(map.strength.iter().flatten().map(|s| s.abs())).map_or(LEAST, |(_, s)| s.max(LEAST));
    let height = TOP + ROW * channels.len() as f64 + FOOT;
    let title = "Residual over its uncertainty, by crank angle and channel";
    let svg = render((WIDTH, height), title, |canvas| {
        let panel = panel(channels.len());
        key(canvas, end)?;
        for (row, strengths) in map.strength.iter().enumerate() {
            cells(canvas, &panel, (row, strengths), end)?;
        }
        for window in &map.windows {
            outline(canvas, &panel, window)?;
        }
        names(canvas, &panel, channels)?;
        panel.lower_axis(canvas, true, CRANK_TITLE)
    })?;
    Ok(Some(Figure {
        name: "where_angle".to_owned(),
        caption: format!(
            "{title}: mean of the recalibrated model's residual over {:.0} deg, in its own standard \
             deviations; what a channel shares with the noise of those above it is taken out. Framed: \
             windows that noise alone would show in fewer than one record of twenty.",
            WIDTHS[0] as f64 * 360.0 / BINS as f64
        ),
        svg,
    }))
}

/// The frame of a map of this many channels.
fn panel(channels: usize) -> Panel {
    Panel {
        left: LEFT,
        top: TOP,
        width: WIDTH - LEFT - RIGHT,
        height: ROW * channels as f64,
        x: Scale::crank(),
        y: Scale::between(channels as f64, 0.0, 1.0),
    }
}

/// One channel: a cell per bin, at the centre of the window that begins there.
fn cells(
    canvas: &Canvas<'_>,
    panel: &Panel,
    (row, strengths): (usize, &[f64]),
    end: f64,
) -> Result<(), ChartError> {
    let bin_deg = 360.0 / BINS as f64;
    let (top, bottom) = (panel.at_y(row as f64), panel.at_y(row as f64 + 1.0));
    for (bin, strength) in strengths.iter().enumerate() {
        let centre = (bin + WIDTHS[0] / 2) % BINS;
        let from = panel.at_x(centre as f64 * bin_deg);
        let to = panel.at_x((centre + 1) as f64 * bin_deg);
        canvas.rectangle(
            (from, top),
            ((to + OVERLAP).min(panel.right()), bottom),
            color::signed(strength / end),
        )?;
    }
    Ok(())
}

/// A significant window; in two parts where it runs through bottom dead centre.
fn outline(canvas: &Canvas<'_>, panel: &Panel, window: &Window) -> Result<(), ChartError> {
    const INSET: f64 = 2.5;
    let pen = Pen {
        color: INK,
        width: 1.3,
    };
    let top = panel.at_y(window.channel as f64) + INSET;
    let bottom = panel.at_y(window.channel as f64 + 1.0) - INSET;
    let (from, to) = (window.from_deg, window.to_deg);
    let parts = if to > 360.0 {
        vec![(from, 360.0), (0.0, to - 360.0)]
    } else {
        vec![(from, to)]
    };
    for (from, to) in parts {
        let (left, right) = (panel.at_x(from), panel.at_x(to));
        canvas.line(&[(left, top), (right, top)], pen)?;
        canvas.line(&[(left, bottom), (right, bottom)], pen)?;
        // a part that goes on beyond bottom dead centre stays open there
        if from > 0.0 || window.from_deg <= 0.0 {
            canvas.line(&[(left, top), (left, bottom)], pen)?;
        }
        if to < 360.0 || window.to_deg <= 360.0 {
            canvas.line(&[(right, top), (right, bottom)], pen)?;
        }
    }
    Ok(())
}

/// Names of the rows.
fn names(canvas: &Canvas<'_>, panel: &Panel, channels: &[String]) -> Result<(), ChartError> {
    let lettering = Lettering::new(11.0, INK).at(HPos::Right, VPos::Center);
    for (row, name) in channels.iter().enumerate() {
        canvas.text((LEFT - 10.0, panel.at_y(row as f64 + 0.5)), name, lettering)?;
    }
    Ok(())
}

/// The colour scale above the map.
fn key(canvas: &Canvas<'_>, end: f64) -> Result<(), ChartError> {
    const BAR: f64 = 180.0;
    const STEPS: usize = 60;
    let y = 15.0;
    let left = WIDTH - RIGHT - BAR - 120.0;
    for step in 0..STEPS {
        let share = (step as f64 + 0.5) / STEPS as f64;
        let x = left + BAR * step as f64 / STEPS as f64;
        canvas.rectangle(
            (x, y - 5.0),
            (x + BAR / STEPS as f64 + OVERLAP, y + 5.0),
            color::signed(2.0 * share - 1.0),
        )?;
    }
    let text = Lettering::new(10.5, GREY);
    let before = format!("simulated too high  −{}", fixed(end, 0));
    canvas.text((left - 8.0, y), &before, text.at(HPos::Right, VPos::Center))?;
    let behind = format!("+{}  too low", fixed(end, 0));
    canvas.text((left + BAR + 8.0, y), &behind, text)
}
