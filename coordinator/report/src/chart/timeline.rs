//! Timeline of the workers: one line for each, from joining to leaving, coloured by the share of its slot time that
//! was spent on results, with marks where attempts failed.
use super::canvas::{Canvas, Pen, TextStyle, WIDTH, render};
use super::panel::Panel;
use super::scale::AxisScale;
use crate::color::{GREY, INK, STRENGTH, VERMILLION};
use crate::document::Figure;
use crate::number::count;
use journal::account::Presence;

const LEFT: f64 = 150.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 44.0;
/// Height of a line, if there are few workers.
const ROW: f64 = 14.0;
/// Maximum height of all lines together; many workers have thin lines without names.
const MOST: f64 = 520.0;
/// Height of a line from which its worker is named.
const NAMED: f64 = 9.0;

/// Draws the presence of the workers over the working time of the run; `None` if nothing is known of it.
pub(crate) fn timeline(presence: &[Presence]) -> Option<Figure> {
    let mut lines: Vec<&Presence> = presence
        .iter()
        .filter(|own| !own.marks.is_empty())
        .collect();
    let end_s = lines
        .iter()
        .flat_map(|own| &own.marks)
        .map(|mark| mark.at_s);
    let end_s = end_s.fold(0.0, f64::max);
    if lines.is_empty() || end_s <= 0.0 {
        return None;
    }
    lines.sort_by(|a, b| joined_s(a).total_cmp(&joined_s(b)));
    let row = ROW.min(MOST / lines.len() as f64);
    let height = row * lines.len() as f64;
    let panel = Panel {
        left: LEFT,
        top: TOP,
        width: WIDTH - LEFT - 10.0,
        height,
        x: AxisScale::between(0.0, end_s, 8.0),
        y: AxisScale::between(0.0, 1.0, 1.0),
    };
    let title = "Workers over time";
    let svg = render((WIDTH, TOP + height + BOTTOM), title, |canvas| {
        for (index, own) in lines.iter().enumerate() {
            let y = TOP + (index as f64 + 0.5) * row;
            if row >= NAMED {
                let name = TextStyle::new(9.5, GREY).right();
                canvas.text((LEFT - 6.0, y), &own.worker.to_string(), name);
            }
            draw(canvas, &panel, own, (y, 0.8 * row));
        }
        panel.lower_axis(canvas, true, "working time of the run [s]");
    });
    Some(Figure {
        name: "timeline".to_owned(),
        caption: format!(
            "{title}: {} lines, each from joining to leaving; the darker, the more of the slots' time was spent on \
             results that count. Coloured marks: attempts that failed. A worker that comes back to a restarted \
             coordinator has another line.",
            count(lines.len() as u64)
        ),
        svg,
    })
}

/// Returns the time at which a worker joined \[s\].
fn joined_s(own: &Presence) -> f64 {
    let first = own.marks.first();
    first.map_or(0.0, |mark| (mark.at_s - mark.connected_s).max(0.0))
}

/// Draws one worker's line at the height `y`.
fn draw(canvas: &mut Canvas, panel: &Panel, own: &Presence, (y, thickness): (f64, f64)) {
    let mut from_s = joined_s(own);
    let (mut useful_s, mut connected_s, mut failed) = (0.0, 0.0, 0);
    for mark in &own.marks {
        let useful = mark.useful_share * mark.connected_s;
        let share = (useful - useful_s) / (mark.connected_s - connected_s);
        let color = STRENGTH.at(0.1 + 0.7 * share.clamp(0.0, 1.0));
        let (left, right) = (panel.at_x(from_s), panel.at_x(mark.at_s));
        canvas.rectangle(
            (left, y - 0.5 * thickness),
            (right, y + 0.5 * thickness),
            color,
        );
        if mark.failed > failed {
            let ends = [(right, y - 0.5 * thickness), (right, y + 0.5 * thickness)];
            canvas.line(&ends, Pen::new(VERMILLION, 2.0));
            if thickness >= NAMED {
                let text = TextStyle::new(9.0, INK).right();
                let more = (mark.failed - failed).to_string();
                canvas.text((right - 3.0, y), &more, text);
            }
        }
        (from_s, useful_s, connected_s, failed) =
            (mark.at_s, useful, mark.connected_s, mark.failed);
    }
}
