//! Crank angle x channel: where in the revolution the residual is no noise.
use super::canvas::{Canvas, Pen, WIDTH, render};
use super::panel::{CRANK_TITLE, Panel};
use super::rows::{self, Key};
use super::scale::Scale;
use crate::report::color::{self, INK};
use crate::report::document::Figure;
use crate::report::number::{fixed, range};
use discrepancy::place::along::{AlongMap, BINS, WIDTHS, Window};

/// The colour scale ends here at the earliest (standard deviations): noise stays pale.
const LEAST: f64 = 5.0;

/// Draws the map; rows are `channels`, in the map's order. None of an empty map.
pub(in crate::report) fn angle_map(map: &AlongMap, channels: &[String]) -> Option<Figure> {
    if map.strength.is_empty() || map.strength.len() != channels.len() {
        return None;
    }
    let end =
        range(map.strength.iter().flatten().map(|s| s.abs())).map_or(LEAST, |(_, s)| s.max(LEAST));
    let height = rows::height(channels.len());
    let title = "Residual over its uncertainty, by crank angle and channel";
    let svg = render((WIDTH, height), title, |canvas| {
        let panel = rows::panel(channels.len(), Scale::crank());
        let high = format!("simulated too high  −{}", fixed(end, 0));
        let low = format!("+{}  too low", fixed(end, 0));
        let signed = |share| color::signed(2.0 * share - 1.0);
        let key = Key {
            before: &high,
            behind: &low,
            room: 120.0,
        };
        rows::key(canvas, signed, &key);
        for (row, strengths) in map.strength.iter().enumerate() {
            cells(canvas, &panel, row, strengths, end);
        }
        for window in &map.windows {
            outline(canvas, &panel, window);
        }
        rows::names(canvas, &panel, channels);
        panel.lower_axis(canvas, true, CRANK_TITLE);
    });
    Some(Figure {
        name: "where_angle".to_owned(),
        caption: format!(
            "{title}: mean of the recalibrated model's residual over {:.0} deg, in its own standard \
             deviations; what a channel shares with the noise of those above it is taken out. Framed: \
             windows that noise alone would show in fewer than one record of twenty.",
            WIDTHS[0] as f64 * 360.0 / BINS as f64
        ),
        svg,
    })
}

/// One channel: a cell per bin, at the centre of the window that begins there.
fn cells(canvas: &mut Canvas, panel: &Panel, row: usize, strengths: &[f64], end: f64) {
    let bin_deg = 360.0 / BINS as f64;
    let (top, bottom) = (panel.at_y(row as f64), panel.at_y(row as f64 + 1.0));
    for (bin, strength) in strengths.iter().enumerate() {
        let centre = (bin + WIDTHS[0] / 2) % BINS;
        let from = panel.at_x(centre as f64 * bin_deg);
        let to = panel.at_x((centre + 1) as f64 * bin_deg);
        canvas.rectangle(
            (from, top),
            ((to + rows::OVERLAP).min(panel.right()), bottom),
            color::signed(strength / end),
        );
    }
}

/// A significant window; in two parts where it runs through bottom dead centre.
fn outline(canvas: &mut Canvas, panel: &Panel, window: &Window) {
    const INSET: f64 = 2.5;
    let pen = Pen::new(INK, 1.3);
    let top = panel.at_y(window.channel as f64) + INSET;
    let bottom = panel.at_y(window.channel as f64 + 1.0) - INSET;
    let (from, to) = (window.from, window.to);
    let parts = if to > 360.0 {
        vec![(from, 360.0), (0.0, to - 360.0)]
    } else {
        vec![(from, to)]
    };
    for (from, to) in parts {
        let (left, right) = (panel.at_x(from), panel.at_x(to));
        canvas.line(&[(left, top), (right, top)], pen);
        canvas.line(&[(left, bottom), (right, bottom)], pen);
        // a part that goes on beyond bottom dead centre stays open there
        if from > 0.0 || window.from <= 0.0 {
            canvas.line(&[(left, top), (left, bottom)], pen);
        }
        if to < 360.0 || window.to <= 360.0 {
            canvas.line(&[(right, top), (right, bottom)], pen);
        }
    }
}
