//! Progress display on standard error: a bar on a terminal, else a line per generation or every ten seconds.
use discrepancy::laboratory::Stage;
use indicatif::{ProgressBar, ProgressStyle};
use journal::event::Spent;
use run::message;
use search::strategy::{CATALOGUE, Preset, preset};
use std::{
    collections::VecDeque,
    io::{self, IsTerminal as _},
    time::{Duration, Instant},
};
use study::{ProgressView, Snapshot, StageView, Watch};

/// Maximum time between two progress lines if there is no terminal.
const LINE_INTERVAL: Duration = Duration::from_secs(10);
/// Minimum time between two queries of the workers' state, since a query costs more than processing a result.
const WORKER_POLL_INTERVAL: Duration = Duration::from_millis(200);

/// Progress display of a calibration or another run of searches.
pub(crate) struct Display {
    /// Unit of the displayed objective, with a leading space; empty if it has no unit.
    unit: String,
    /// Name of the quantity that the display counts besides simulations, such as generations.
    counted: &'static str,
    bar: Option<ProgressBar>,
    last: Instant,
    generation: Option<u32>,
    /// Number of results in the journal from earlier sessions, which are read at once and not simulated
    /// again.
    recorded: u64,
    /// Preset of the search, until the user has been told that there are more slots than it fills.
    preset: Option<&'static Preset>,
}

impl Display {
    /// Creates the progress display of a calibration; the objective is in the square of `unit`.
    pub(crate) fn new(unit: Option<&str>) -> Self {
        Self::counting("generation or stage", unit)
    }

    /// Makes the display say once if more slots are connected than the preset with this name fills.
    pub(crate) fn of_preset(self, name: &str) -> Self {
        Self {
            preset: preset(name),
            ..self
        }
    }

    /// Tells the user once that more slots are connected than the search fills.
    fn print_surplus(&mut self, snapshot: &Snapshot) {
        let slots: u64 = snapshot
            .workers
            .iter()
            .map(|own| u64::from(own.slots))
            .sum();
        if let Some(preset) = self.preset
            && let Some(note) = surplus(preset, slots)
        {
            self.preset = None;
            message::print(&note);
        }
    }

    /// Creates a progress display that counts `counted`, such as searches, instead of the generations of one
    /// search.
    pub(crate) fn counting(counted: &'static str, unit: Option<&str>) -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let template = "{bar:32} {pos}/{len}  {msg}";
            let style = ProgressStyle::with_template(template)
                .unwrap_or_else(|_| ProgressStyle::default_bar())
                .progress_chars("=> ");
            ProgressBar::new(1).with_style(style)
        });
        Self {
            unit: unit.map_or_else(String::new, |unit| format!(" {unit}^2")),
            counted,
            bar,
            last: Instant::now(),
            generation: None,
            recorded: 0,
            preset: None,
        }
    }

    pub(crate) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Progress display of a diagnosis: stage, simulations and workers.
pub(crate) struct StageDisplay {
    bar: Option<ProgressBar>,
    last: Instant,
    stage: Option<Stage>,
    pace: Pace,
}

impl StageDisplay {
    pub(crate) fn new() -> Self {
        let bar = io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{spinner} {msg}")
                .unwrap_or_else(|_| ProgressStyle::default_spinner());
            ProgressBar::new_spinner().with_style(style)
        });
        Self {
            bar,
            last: Instant::now(),
            stage: None,
            pace: Pace::default(),
        }
    }

    pub(crate) fn clear(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Watch<StageView> for StageDisplay {
    fn noted(&mut self, notes: &[String]) {
        message::print_notes(notes);
    }

    fn progress(&mut self, view: &StageView, snapshot: &dyn Fn() -> Snapshot) {
        let StageView {
            stage, done, open, ..
        } = *view;
        let now = Instant::now();
        let pace = self.pace.of(now, view.spent);
        let silent = now.duration_since(self.last);
        let patience = if self.bar.is_some() {
            WORKER_POLL_INTERVAL
        } else {
            LINE_INTERVAL
        };
        if self.stage == Some(stage) && silent < patience {
            return;
        }
        self.last = now;
        self.stage = Some(stage);
        let workers = at_work(&snapshot());
        let line = format!(
            "{}: {done} simulations, {open} open  {}{workers}",
            stage.name(),
            pace.map_or_else(String::new, |pace| {
                let left = Duration::from_secs_f64(view.left / pace);
                format!("at most {} more  ", clock(left))
            })
        );
        match &self.bar {
            Some(bar) => {
                bar.set_message(line);
                bar.tick();
            }
            None => message::print(&line),
        }
    }
}

/// Rate of work over a sliding time window; results read at once from the journal soon leave the window.
#[derive(Default)]
struct Pace {
    seen: VecDeque<(Instant, f64)>,
}

impl Pace {
    /// Records the total work `spent` by time `now` and returns its rate per second; `None` until more than 8
    /// s have been observed.
    fn of(&mut self, now: Instant, spent: f64) -> Option<f64> {
        const WINDOW: Duration = Duration::from_secs(45);
        const ENOUGH: Duration = Duration::from_secs(8);
        self.seen.push_back((now, spent));
        while let [(then, _), ..] = self.seen.make_contiguous()
            && now.duration_since(*then) > WINDOW
        {
            self.seen.pop_front();
        }
        let (then, before) = *self.seen.front()?;
        let passed = now.duration_since(then);
        let pace = (spent - before) / passed.as_secs_f64();
        (passed > ENOUGH && pace > 0.0).then_some(pace)
    }
}

/// Progress display that shows notes alone, for a step that is short.
pub(crate) struct Silent;

impl<V> Watch<V> for Silent {
    fn noted(&mut self, notes: &[String]) {
        message::print_notes(notes);
    }

    fn progress(&mut self, _view: &V, _crew: &dyn Fn() -> Snapshot) {}
}

impl Watch<ProgressView> for Display {
    fn noted(&mut self, notes: &[String]) {
        message::print_notes(notes);
    }

    fn resumed(&mut self, recorded: usize) {
        self.recorded = recorded as u64;
    }

    fn progress(&mut self, view: &ProgressView, snapshot: &dyn Fn() -> Snapshot) {
        // what is only read again needs neither workers nor lines
        let reading = view.completed == view.replayed && view.completed < self.recorded;
        if reading && view.completed < view.expected {
            return;
        }
        let now = Instant::now();
        let silent = now.duration_since(self.last);
        let due = match &self.bar {
            Some(_) => silent >= WORKER_POLL_INTERVAL,
            None => self.generation != Some(view.generation) || silent >= LINE_INTERVAL,
        };
        if !due && view.completed < view.expected {
            return;
        }
        self.last = now;
        self.generation = Some(view.generation);
        let snapshot = snapshot();
        self.print_surplus(&snapshot);
        let words = describe(view, (self.counted, &self.unit), &snapshot);
        match &self.bar {
            Some(bar) => {
                bar.set_length(view.expected);
                bar.set_position(view.completed);
                bar.set_message(words);
            }
            None => message::print(&format!("{}/{}  {words}", view.completed, view.expected)),
        }
    }
}

/// Returns a note if there are more slots than a preset fills, with the presets that fill more; `None` otherwise.
fn surplus(preset: &Preset, slots: u64) -> Option<String> {
    if slots <= preset.slots {
        return None;
    }
    let wider = CATALOGUE.iter().filter(|other| other.slots > preset.slots);
    let wider: Vec<&str> = wider.map(|other| other.name).collect();
    let wider = if wider.is_empty() {
        String::new()
    } else {
        format!("; {} fill more", wider.join(", "))
    };
    Some(format!(
        "note: {slots} slots are connected, and a search with preset {} keeps at least half busy of at most {}{wider}",
        preset.name, preset.slots
    ))
}

/// Formats the progress line: generation or stage, best objective, failures, workers, rate, remaining time.
fn describe(view: &ProgressView, (counted, unit): (&str, &str), snapshot: &Snapshot) -> String {
    let mut parts = Vec::new();
    // before the first is asked for there is nothing to count, and one of one says nothing
    if view.generations > 1 {
        parts.push(format!(
            "{counted} {} of {}",
            view.generation, view.generations
        ));
    }
    if let Some(best) = view.best {
        parts.push(format!("best {best:.4}{unit}"));
    }
    if view.failed > 0 {
        parts.push(format!("{} failed", view.failed));
    }
    let read_only = view.completed > 0 && view.completed == view.replayed;
    parts.push(if read_only && snapshot.workers.is_empty() {
        "all from the journal".to_owned()
    } else {
        at_work(snapshot)
    });
    parts.extend(slot_use(&snapshot.spent));
    if let Some(rate) = view.rate(snapshot.computing) {
        parts.push(format!("{rate:.1}/s"));
    }
    if let Some(left) = view.remaining(snapshot.computing) {
        parts.push(format!("{} left", clock(left)));
    }
    parts.join("  ")
}

/// Describes the connected workers. Before the first job is dispatched, workers fetch the case and build the
/// model.
fn at_work(snapshot: &Snapshot) -> String {
    let workers = match snapshot.workers.len() {
        0 => return "waiting for workers".to_owned(),
        1 => "1 worker".to_owned(),
        several => format!("{several} workers"),
    };
    if snapshot.computing.is_zero() {
        return format!("waiting for {workers} to get ready");
    }
    workers
}

/// Formats the shares of time that worker slots spend on each activity, for example `slots 91 % useful, 8 %
/// barrier`; `None` below 5 s of connected slot time.
fn slot_use(spent: &Spent) -> Option<String> {
    if spent.connected_us < 5_000_000 {
        return None;
    }
    let percent = |us: u64| 100.0 * us as f64 / spent.connected_us as f64;
    let kinds = spent
        .kinds()
        .into_iter()
        .map(|(kind, us)| (kind, percent(us)));
    let shown: Vec<String> = kinds
        .filter(|(kind, share)| *kind == "useful" || *share >= 1.0)
        .map(|(kind, share)| format!("{share:.0} % {kind}"))
        .collect();
    Some(format!("slots {}", shown.join(", ")))
}

/// Formats a duration as `42 s`, `3 min 05 s` or `2 h 07 min`.
fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{} min {:02} s", seconds / 60, seconds % 60),
        _ => format!("{} h {:02} min", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::event::WorkerAccount;
    use protocol::id::WorkerId;

    #[test]
    fn more_slots_than_a_preset_fills_are_noted_with_the_presets_that_fill_them() {
        let paper = preset("paper").unwrap();
        assert_eq!(surplus(paper, paper.slots), None);
        let note = surplus(paper, paper.slots + 1).unwrap();
        assert!(
            note.contains("preset paper") && note.contains("window"),
            "{note}"
        );
        let widest = CATALOGUE.iter().max_by_key(|preset| preset.slots).unwrap();
        assert!(!surplus(widest, u64::MAX).unwrap().contains("fill more"));
    }

    #[test]
    fn a_line_says_everything_that_is_known() {
        let view = ProgressView {
            generation: 3,
            generations: 60,
            completed: 240,
            expected: 6080,
            failed: 12,
            replayed: 40,
            best: Some(0.31239),
        };
        let words = ("generation or stage", " N^2");
        let mut snapshot = Snapshot::default();
        assert_eq!(
            describe(&ProgressView::default(), words, &snapshot),
            "waiting for workers"
        );
        snapshot.workers.push(WorkerAccount {
            worker: WorkerId(1),
            host: "node-1".to_owned(),
            slots: 1,
            done: 0,
            failed: 0,
            spent: Spent::default(),
        });
        assert_eq!(
            describe(&ProgressView::default(), words, &snapshot),
            "waiting for 1 worker to get ready"
        );
        snapshot.computing = Duration::from_secs(20);
        assert_eq!(
            describe(&view, words, &snapshot),
            "generation or stage 3 of 60  best 0.3124 N^2  12 failed  1 worker  10.0/s  9 min 44 s left"
        );
        snapshot.spent = Spent {
            connected_us: 10_000_000,
            useful_us: 8_950_000,
            barrier_us: 1_000_000,
            starved_us: 50_000,
            ..Spent::default()
        };
        let line = describe(&view, (words.0, ""), &snapshot);
        assert!(
            line.contains("1 worker  slots 90 % useful, 10 % barrier  10.0/s"),
            "{line}"
        );
    }
}
