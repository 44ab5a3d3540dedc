//! Layout shared by maps with one row per channel: frame, channel names, colour scale.
use super::canvas::{Canvas, TextStyle, WIDTH};
use super::panel::Panel;
use super::scale::AxisScale;
use crate::color::{GREY, INK, Ramp};

const LEFT: f64 = 104.0;
const RIGHT: f64 = 20.0;
const TOP: f64 = 40.0;
const ROW: f64 = 30.0;
const FOOT: f64 = 46.0;
/// Overlap of adjacent cells [px], which avoids visible seams.
pub(super) const OVERLAP: f64 = 0.5;

/// Returns the height of a map with `rows` channels [px].
pub(super) fn height(rows: usize) -> f64 {
    TOP + ROW * rows as f64 + FOOT
}

/// Returns the panel of a map with `rows` channels; channel `k` lies between `k` and `k + 1` on its vertical
/// scale.
pub(super) fn panel(rows: usize, x: AxisScale) -> Panel {
    Panel {
        left: LEFT,
        top: TOP,
        width: WIDTH - LEFT - RIGHT,
        height: ROW * rows as f64,
        x,
        y: AxisScale::between(rows as f64, 0.0, 1.0),
    }
}

/// Draws the names of the channels to the left of a map's rows.
pub(super) fn names(canvas: &mut Canvas, panel: &Panel, channels: &[String]) {
    let lettering = TextStyle::new(11.0, INK).right();
    for (row, name) in channels.iter().enumerate() {
        canvas.text((LEFT - 10.0, panel.at_y(row as f64 + 0.5)), name, lettering);
    }
}

/// Labels to the left and right of a map's colour scale.
pub(super) struct Key<'a> {
    /// Label to the left of the scale.
    pub before: &'a str,
    /// Label to the right of the scale.
    pub behind: &'a str,
    /// Width reserved for the right label [px].
    pub room: f64,
}

/// Draws the colour scale with its labels above the map.
pub(super) fn key(canvas: &mut Canvas, ramp: &Ramp, key: &Key<'_>) {
    const BAR: f64 = 180.0;
    const STEPS: usize = 60;
    let y = 15.0;
    let left = WIDTH - RIGHT - BAR - key.room;
    for step in 0..STEPS {
        let x = left + BAR * step as f64 / STEPS as f64;
        canvas.rectangle(
            (x, y - 5.0),
            (x + BAR / STEPS as f64 + OVERLAP, y + 5.0),
            ramp.at((step as f64 + 0.5) / STEPS as f64),
        );
    }
    let text = TextStyle::new(10.5, GREY);
    canvas.text((left - 8.0, y), key.before, text.right());
    canvas.text((left + BAR + 8.0, y), key.behind, text);
}
