//! What each worker contributed: evaluations and the busy share of its slots.
use super::canvas::{Lettering, render};
use crate::color::{BAND, BLUE, GREY, INK};
use crate::data::WorkerUse;
use crate::document::Figure;
use crate::number::{count, percent};

const WIDTH: f64 = 720.0;
const ROW: f64 = 22.0;
const TOP: f64 = 30.0;
const LEFT: f64 = 190.0;
const BAR: f64 = 330.0;
/// Workers drawn at most; the table has all of them.
const MOST: usize = 40;

/// Draws one bar per worker; none without workers.
pub(crate) fn workers(workers: &[WorkerUse]) -> Option<Figure> {
    // bars that are all empty would show nothing
    if workers.iter().all(|worker| worker.busy_share().is_none()) {
        return None;
    }
    let shown = &workers[..workers.len().min(MOST)];
    let height = TOP + ROW * shown.len() as f64 + 8.0;
    let title = "Use of the workers";
    let svg = render((WIDTH, height), title, |canvas| {
        let head = Lettering::new(10.5, GREY);
        canvas.text((LEFT, 14.0), "slot time spent on results", head);
        let right = head.right();
        canvas.text((WIDTH - 60.0, 14.0), "jobs done", right);
        for (index, worker) in shown.iter().enumerate() {
            let y = TOP + (index as f64 + 0.5) * ROW - 2.0;
            let name = Lettering::new(11.0, INK).right();
            canvas.text((LEFT - 10.0, y), &worker.name, name);
            canvas.rectangle((LEFT, y - 6.0), (LEFT + BAR, y + 6.0), BAND);
            let share = worker.busy_share();
            let filled = BAR * share.unwrap_or(0.0).clamp(0.0, 1.0);
            canvas.rectangle((LEFT, y - 6.0), (LEFT + filled, y + 6.0), BLUE);
            let text = share.map_or_else(|| "not known".to_owned(), percent);
            canvas.text((LEFT + BAR + 8.0, y), &text, Lettering::new(11.0, INK));
            let done = Lettering::new(11.0, INK).right();
            canvas.text((WIDTH - 60.0, y), &count(worker.done), done);
        }
    });
    let left_out = if workers.len() > MOST {
        format!(" The first {MOST} of {} workers.", workers.len())
    } else {
        String::new()
    };
    Some(Figure {
        name: "workers".to_owned(),
        caption: format!(
            "{title}: share of the slot time, while attached, that was spent on accepted results.{left_out}"
        ),
        svg,
    })
}
