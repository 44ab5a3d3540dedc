//! Report section on the utilisation of the workers: tables and figure.
use crate::chart::canvas::{TextStyle, render};
use crate::chart::timeline;
use crate::color::{BAND, BLUE, GREY, INK};
use crate::data::Calibration;
use crate::document::{Block, Figure, Row, Section, Table, figures};
use crate::number::{MISSING, count, duration, percent};
use journal::account;
use journal::account::RunAccount;
use journal::event::{Spent, WorkerAccount};

pub(super) fn calibration(calibration: &Calibration) -> Section {
    let mut blocks = Vec::new();
    if !calibration.workers.is_empty() {
        blocks.extend(figures(timeline(&calibration.presence)));
        blocks.extend(figures(chart(&calibration.workers)));
        blocks.extend([
            Block::Table(slot_time(&calibration.spent)),
            Block::List(account::reasons(&calibration.spent)),
            Block::Table(workers(&calibration.workers)),
        ]);
    }
    Section {
        id: "workers",
        title: "Use of the workers",
        blocks,
    }
}

/// Builds the table of the work done by each worker.
pub(crate) fn workers(workers: &[WorkerAccount]) -> Table {
    let rows = workers.iter().map(|worker| {
        Row::new(
            worker.worker.to_string(),
            [
                worker.host.clone(),
                worker.slots.to_string(),
                count(worker.done),
                count(worker.failed),
                duration(worker.busy_s()),
                worker
                    .busy_share()
                    .map_or_else(|| MISSING.to_owned(), percent),
            ],
        )
    });
    Table::new(
        "Workers",
        [
            "worker",
            "host",
            "slots",
            "jobs done",
            "failed",
            "computing",
            "busy",
        ],
        rows.collect(),
    )
    .with_notes(["Busy: time spent on accepted results over slots times the time attached."])
}

/// Builds the table of slot time by use: useful, waiting, speculative, failed and lost.
pub fn slot_time(spent: &Spent) -> Table {
    let what = |kind: &str| match kind {
        "useful" => "computing results that were used",
        "barrier" => "waiting for results of others",
        "starved" => "waiting for the case, an order or the journal",
        "speculative" => "copies that came second, and jobs computed ahead but never requested",
        "failed" => "attempts that crashed or ran out of time",
        _ => "attempts whose worker was lost",
    };
    let rows = spent.kinds().map(|(kind, us)| {
        let share = us as f64 / spent.connected_us.max(1) as f64;
        Row::new(
            kind,
            [
                duration(us as f64 / 1e6),
                percent(share),
                what(kind).to_owned(),
            ],
        )
    });
    Table::new(
        "Slot time",
        ["use", "time", "share", "what it was"],
        rows.into(),
    )
    .with_notes([format!(
        "Slots were connected for {} in all.",
        duration(spent.connected_us as f64 / 1e6)
    )])
}

/// Builds the table of the results and useful slot time of each host.
pub fn hosts(account: &RunAccount) -> Table {
    let rows = account.hosts().into_iter().map(|(host, used)| {
        let share = used.spent.useful_us as f64 / used.spent.connected_us.max(1) as f64;
        Row::new(
            host,
            [
                count(used.workers),
                used.slots.to_string(),
                count(used.done),
                count(used.failed),
                duration(used.spent.useful_us as f64 / 1e6),
                percent(share),
            ],
        )
    });
    Table::new(
        "Machines",
        [
            "machine", "workers", "slots", "results", "failed", "useful", "share",
        ],
        rows.collect(),
    )
}

/// Builds the table of job durations by kind of job.
pub fn jobs(account: &RunAccount) -> Table {
    let rows = account.jobs.iter().map(|(kind, used)| {
        Row::new(
            *kind,
            [
                count(used.results),
                count(used.machine_failed),
                duration(used.median_s),
                duration(used.usual_s),
                duration(used.longest_s),
                duration(used.wall_s),
                duration(used.processor_s),
            ],
        )
    });
    Table::new(
        "Jobs",
        [
            "kind",
            "results",
            "machine failed",
            "median",
            "95 %",
            "longest",
            "in the slot",
            "processor",
        ],
        rows.collect(),
    )
}

const WIDTH: f64 = 720.0;
const ROW: f64 = 22.0;
const TOP: f64 = 30.0;
const LEFT: f64 = 190.0;
const BAR: f64 = 330.0;
/// Maximum number of workers drawn; the table lists all.
const MOST: usize = 40;

/// Draws one bar per worker; `None` if the busy share of no worker is known.
pub(crate) fn chart(workers: &[WorkerAccount]) -> Option<Figure> {
    // bars that are all empty would show nothing
    if workers.iter().all(|worker| worker.busy_share().is_none()) {
        return None;
    }
    let shown = &workers[..workers.len().min(MOST)];
    let height = TOP + ROW * shown.len() as f64 + 8.0;
    let title = "Use of the workers";
    let svg = render((WIDTH, height), title, |canvas| {
        let head = TextStyle::new(10.5, GREY);
        canvas.text((LEFT, 14.0), "slot time spent on results", head);
        let right = head.right();
        canvas.text((WIDTH - 60.0, 14.0), "jobs done", right);
        for (index, worker) in shown.iter().enumerate() {
            let y = TOP + (index as f64 + 0.5) * ROW - 2.0;
            let name = TextStyle::new(11.0, INK).right();
            canvas.text((LEFT - 10.0, y), &worker.worker.to_string(), name);
            canvas.rectangle((LEFT, y - 6.0), (LEFT + BAR, y + 6.0), BAND);
            let share = worker.busy_share();
            let filled = BAR * share.unwrap_or(0.0).clamp(0.0, 1.0);
            canvas.rectangle((LEFT, y - 6.0), (LEFT + filled, y + 6.0), BLUE);
            let text = share.map_or_else(|| "not known".to_owned(), percent);
            canvas.text((LEFT + BAR + 8.0, y), &text, TextStyle::new(11.0, INK));
            let done = TextStyle::new(11.0, INK).right();
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
