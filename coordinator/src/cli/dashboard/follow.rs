//! Following of one run: its study is repeated on the growing journal in one thread, and its page is rendered
//! in another.
use super::{
    sections::{self, ComparedRuns, pair},
    simulator::{Awaited, HashedCase, Simulated, Simulator},
    state::{RunState, SharedState},
};
use crate::cli::run::{
    dispatcher,
    folder::{MANIFEST, RESULT, RunFolder},
    kind::AnyRun,
    manifest::{CALIBRATE, DIAGNOSE, IDENTIFY},
};
use dashboard::{Board, PageReader, Pages};
use journal::event::{Event, Finished};
use journal::{Damage, Growth, JournalEntry, JournalFollower};
use protocol::{case::Case, job::Job};
use report::{Block, Report, Section, document::section_markup};
use std::{
    fs,
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant, SystemTime},
};
use study::{FollowObserver, FollowingEvaluator, StudyError};
use tokio::sync::{oneshot, watch};

/// Interval at which the page of a run is rendered, if something has changed.
const INTERVAL: Duration = Duration::from_millis(400);
/// Minimum share of time that rendering leaves to others: a page that takes long is rendered less often.
const REST: u32 = 9;
/// Time after which a run that could not be followed is tried again if its journal has grown; reading its case may
/// take seconds.
const RETRY: Duration = Duration::from_secs(30);
/// Minimum time between two simulations of the best individual so far.
const BEST_INTERVAL: Duration = Duration::from_secs(4);
/// Longest wait for the result file of a run whose last result is in the journal, and for the last results of a run
/// whose result file is written.
const RESULT_WAIT: Duration = Duration::from_secs(5);

/// Run that is followed until this value is dropped.
pub(super) struct Followed {
    shared: Arc<Shared>,
    reader: PageReader,
    stop: watch::Sender<bool>,
}

/// What the threads of a followed run share.
struct Shared {
    path: PathBuf,
    state: SharedState,
    run: Mutex<Option<OpenedRun>>,
    /// Command of a run whose results alone are shown, such as a sweep.
    other: Mutex<Option<String>>,
    ending: Mutex<Ending>,
    simulator: Simulator,
    stopped: watch::Receiver<bool>,
}

/// End of a followed study.
#[derive(Clone, Default)]
struct Ending {
    /// Report of the finished run.
    report: Option<Arc<Report>>,
    /// Why the study could not go on.
    error: Option<String>,
}

/// Run as it was opened last.
#[derive(Clone)]
struct OpenedRun {
    run: Arc<AnyRun>,
    case: Arc<HashedCase>,
}

impl Followed {
    /// Begins to follow the run in a folder, which need not exist yet.
    pub(super) fn begin(path: &Path, simulator: &Simulator) -> Self {
        let name = path.display().to_string();
        let board = Board::new(&name, &name);
        let reader = board.reader();
        let (stop, stopped) = watch::channel(false);
        let shared = Arc::new(Shared {
            path: path.to_owned(),
            state: SharedState::default(),
            run: Mutex::default(),
            other: Mutex::default(),
            ending: Mutex::default(),
            simulator: simulator.clone(),
            stopped,
        });
        let own = Arc::clone(&shared);
        thread::spawn(move || own.follow());
        let own = Arc::clone(&shared);
        thread::spawn(move || own.render(board));
        Self {
            shared,
            reader,
            stop,
        }
    }

    pub(super) fn reader(&self) -> PageReader {
        self.reader.clone()
    }

    /// Returns whether the page shows the end of the run.
    pub(super) fn has_ended(&self) -> bool {
        self.reader.borrow().state == FINISHED
    }

    /// Returns the HTML of one individual beside the recommended one; `None` if there is no such individual.
    pub(super) async fn individual(&self, number: u64) -> Option<String> {
        let run = self.shared.opened()?;
        let case = &run.case;
        let genes = {
            let state = self.shared.state.lock();
            state.history.get(&number)?.genes.clone()
        };
        let both = [case.case.start(), genes.clone()].map(|one| self.shared.runs_of(case, &one));
        let mut found = Vec::new();
        for one in both {
            found.push(match one {
                Ok(known) => Ok(known),
                Err(asked) => asked
                    .await
                    .unwrap_or_else(|_| Err("the dashboard ends".to_owned())),
            });
        }
        let section = match found.as_slice() {
            [Ok(recommended), Ok(own)] => {
                let conditions = pair(recommended, own);
                report::individual(&case.case, (number, &genes), &conditions)
            }
            [Err(why), _] | [_, Err(why)] => Section {
                id: "one-individual",
                title: "One individual",
                blocks: vec![Block::Warning(vec![format!(
                    "Individual {number} could not be simulated: {why}"
                )])],
            },
            _ => return None,
        };
        Some(section_markup(&section).into_string())
    }
}

impl Drop for Followed {
    fn drop(&mut self) {
        self.stop.send_replace(true);
    }
}

/// Length and inode of a file, which tell whether it has changed; 0 if there is none.
fn stamp(path: &Path) -> (u64, u64) {
    fs::metadata(path).map_or((0, 0), |file| (file.len(), file.ino()))
}

/// State of a finished run whose journal lacks results.
const INCOMPLETE: &str = "incomplete";
/// State of a run whose result is written.
const FINISHED: &str = "finished";

impl Shared {
    fn is_stopped(&self) -> bool {
        *self.stopped.borrow()
    }

    fn opened(&self) -> Option<OpenedRun> {
        let run = self.run.lock().unwrap_or_else(PoisonError::into_inner);
        run.clone()
    }

    fn ending(&self) -> Ending {
        let ending = self.ending.lock().unwrap_or_else(PoisonError::into_inner);
        ending.clone()
    }

    fn end(&self, ending: Ending) {
        *self.ending.lock().unwrap_or_else(PoisonError::into_inner) = ending;
    }

    /// Returns length and inode of the manifest and the journal.
    fn stamps(&self) -> [(u64, u64); 2] {
        [MANIFEST, journal::FILE].map(|file| stamp(&self.path.join(file)))
    }

    /// Follows the run to its end; a run that cannot be followed is tried again when its files have changed.
    fn follow(&self) {
        while !self.is_stopped() {
            let before = self.stamps();
            let followed = self.study();
            let ended = followed.is_ok();
            self.end(match followed {
                Ok(report) => Ending {
                    report: Some(Arc::new(report)),
                    error: None,
                },
                Err(error) => Ending {
                    report: None,
                    error: Some(format!("{error:#}")),
                },
            });
            // a run that is over is followed again only if another takes its place; one that cannot be followed if its
            // files were replaced, and from time to time if its journal grows
            let tried = Instant::now();
            let is_due = |now: [(u64, u64); 2]| {
                let [manifest, journal] = now;
                let replaced = manifest != before[0] || journal.1 != before[1].1;
                if ended {
                    manifest.0 > 0 && journal.1 != before[1].1
                } else {
                    replaced || (now != before && tried.elapsed() > RETRY)
                }
            };
            while !self.is_stopped() && !is_due(self.stamps()) {
                thread::sleep(INTERVAL);
            }
        }
    }

    /// Repeats the study of the run as its results arrive, and returns the report of its end.
    fn study(&self) -> anyhow::Result<Report> {
        if self.opened().is_some() && !RunFolder::new(&self.path).is_begun() {
            anyhow::bail!("the run folder was deleted; what was read before stays on this page");
        }
        let kind = RunFolder::at(&self.path)?.head()?.kind;
        if ![CALIBRATE, DIAGNOSE, IDENTIFY].contains(&kind.as_str()) {
            return self.count_results(&kind);
        }
        let run = Arc::new(AnyRun::open(&self.path)?);
        *self.run.lock().unwrap_or_else(PoisonError::into_inner) = Some(OpenedRun {
            run: Arc::clone(&run),
            case: HashedCase::new(run.case())?,
        });
        let mut stop = self.stopped.clone();
        let mut watch = self.state.clone();
        let mut observer = Observer {
            shared: self,
            has_begun: false,
        };
        let mut evaluator = FollowingEvaluator::new(&self.path.join(journal::FILE), &mut observer);
        dispatcher::block_on(async { run.replay(&mut evaluator, &mut watch, &mut stop).await })?;
        run.report(self.wall_s()?)
    }

    /// Follows the journal of a run whose study is not repeated, such as a sweep or requests of another program,
    /// and returns a report of its results and workers.
    fn count_results(&self, kind: &str) -> anyhow::Result<Report> {
        self.state.clear();
        *self.other.lock().unwrap_or_else(PoisonError::into_inner) = Some(kind.to_owned());
        self.end(Ending::default());
        let folder = RunFolder::new(&self.path);
        let mut journal = JournalFollower::new(&folder.file(journal::FILE));
        let mut observer = self.state.clone();
        loop {
            let was_finished = folder.is_finished();
            let growth = journal.read(|entry, event| observer.event(entry, event))?;
            observer.read(growth, journal.position(), journal.damage());
            if self.is_stopped() {
                return Err(StudyError::Interrupted.into());
            }
            if growth == Growth::Replaced || (growth == Growth::Missing && !folder.is_begun()) {
                anyhow::bail!("the run folder was deleted");
            }
            if was_finished && growth == Growth::Unchanged {
                let state = self.state.lock();
                let title = sections::other_title(kind, &self.path);
                return Ok(Report::new(title, "", sections::other(kind, &state)));
            }
            thread::sleep(INTERVAL);
        }
    }

    /// Waits for the result of the run and returns the wall time in it (s).
    fn wall_s(&self) -> anyhow::Result<f64> {
        let begun = Instant::now();
        let folder = RunFolder::new(&self.path);
        while !folder.is_finished() && begun.elapsed() < RESULT_WAIT {
            if self.is_stopped() {
                return Err(StudyError::Interrupted.into());
            }
            thread::sleep(INTERVAL);
        }
        let result: serde_json::Value = folder.read_json(RESULT)?;
        Ok(result["wall_s"].as_f64().unwrap_or_default())
    }

    /// Returns the runs of an individual if they are known, from the journal or a former simulation; otherwise
    /// requests their simulation.
    fn runs_of(&self, case: &Arc<HashedCase>, genes: &[f64]) -> Result<Simulated, Awaited> {
        self.known(case, genes)
            .ok_or_else(|| self.simulator.simulate(case, genes))
    }

    fn known(&self, case: &HashedCase, genes: &[f64]) -> Option<Simulated> {
        self.simulator
            .known(case, genes)
            .or_else(|| recorded(&case.case, &self.state.lock(), genes))
    }

    /// Renders the page until the follower is dropped.
    fn render(&self, mut board: Board) {
        let mut shown = None;
        let mut pictures = BestPictures::default();
        // the last version of the state, and when it was seen first
        let mut heard = (0, Instant::now());
        while !self.is_stopped() {
            let begun = Instant::now();
            let ending = self.ending();
            let run = self.opened();
            let other = self
                .other
                .lock()
                .unwrap_or_else(PoisonError::into_inner)
                .clone();
            let version = self.state.lock().version;
            if version != heard.0 {
                heard = (version, begun);
            }
            let word = self.state_word(&ending, begun - heard.1);
            let drawn = run
                .as_ref()
                .is_some_and(|run| pictures.update(self, run, ending.report.is_some()));
            let present = (
                version,
                word.clone(),
                ending.error.clone(),
                ending.report.is_some(),
            );
            if drawn || shown.as_ref() != Some(&present) {
                let state = self.state.lock().clone();
                let title = match (&run, &other) {
                    (Some(opened), _) => sections::title(&opened.run),
                    (None, Some(kind)) => sections::other_title(kind, &self.path),
                    (None, None) => self.path.display().to_string(),
                };
                let lacking = (word == INCOMPLETE).then_some(
                    "Results of this run are missing from its journal. The page shows what is left; the command that \
                     began the run computes them again.",
                );
                let error = ending.error.as_deref().or(lacking);
                let mut page = vec![sections::notices(&state, error)];
                match (&ending.report, &run) {
                    (Some(report), _) => page.extend(report.sections.iter().cloned()),
                    (None, Some(opened)) => {
                        page.extend(sections::unfinished(
                            &opened.run,
                            &state,
                            pictures.compared(),
                        ));
                    }
                    (None, None) => {
                        if let Some(kind) = &other {
                            page.extend(sections::other(kind, &state));
                        }
                    }
                }
                board.publish(
                    (&title, &word),
                    &page,
                    ending.report.is_some() || ending.error.is_some(),
                );
                shown = Some(present);
            }
            thread::sleep(INTERVAL.max(REST * begun.elapsed()));
        }
    }

    /// Returns the state of the run in a word or two; `quiet` is the time since anything was read.
    fn state_word(&self, ending: &Ending, quiet: Duration) -> String {
        let folder = RunFolder::new(&self.path);
        if ending.report.is_some() {
            FINISHED.to_owned()
        } else if !folder.is_begun() {
            if self.opened().is_some() {
                "deleted".to_owned()
            } else {
                "no run".to_owned()
            }
        } else if is_locked(&self.path) {
            "running".to_owned()
        } else if folder.is_finished() {
            if quiet < RESULT_WAIT {
                "reading".to_owned()
            } else {
                INCOMPLETE.to_owned()
            }
        } else if has_grown_lately(&self.path) {
            "running".to_owned()
        } else {
            "stopped".to_owned()
        }
    }
}

/// Observer of a journal that forgets what was known, and why it could not be followed before, when the journal is
/// read for the first time.
struct Observer<'a> {
    shared: &'a Shared,
    has_begun: bool,
}

impl Observer<'_> {
    fn begin(&mut self) {
        if !self.has_begun {
            self.has_begun = true;
            self.shared.state.clear();
            self.shared.end(Ending::default());
        }
    }
}

impl FollowObserver for Observer<'_> {
    fn event(&mut self, entry: JournalEntry, event: &Event) {
        self.begin();
        self.shared.state.clone().event(entry, event);
    }

    fn result(&mut self, job: &Job, finished: &Finished) {
        self.shared.state.clone().result(job, finished);
    }

    fn read(&mut self, growth: Growth, position: u64, damage: &[Damage]) {
        self.shared.state.clone().read(growth, position, damage);
    }
}

/// Returns whether a process of this machine has locked the journal in a run folder, or the file that earlier
/// versions lock, from the kernel's table of locks.
pub(super) fn is_locked(run: &Path) -> bool {
    let journal = run.join(journal::FILE);
    let table = fs::read_to_string("/proc/locks").unwrap_or_default();
    for file in [&journal, &run.join(journal::LOCK)] {
        let Ok(file) = fs::metadata(file) else {
            continue;
        };
        let suffix = format!(":{}", file.ino());
        let mut words = table.split_whitespace();
        if words.any(|word| word.ends_with(&suffix) && word.matches(':').count() == 2) {
            return true;
        }
    }
    false
}

/// Returns whether the journal in a run folder was written a short time ago, by which an unfinished run of another
/// machine is seen to go on.
pub(super) fn has_grown_lately(run: &Path) -> bool {
    let journal = run.join(journal::FILE);
    let changed = fs::metadata(journal).and_then(|file| file.modified());
    let age = changed.map(|at| SystemTime::now().duration_since(at).unwrap_or_default());
    age.is_ok_and(|age| age < Duration::from_secs(10))
}

/// Returns the runs of an individual that the run itself simulated for its tables, if all are there.
fn recorded(case: &Case, state: &RunState, genes: &[f64]) -> Option<Simulated> {
    let bits: Vec<u64> = genes.iter().map(|gene| gene.to_bits()).collect();
    let mut runs = Vec::new();
    for wanted in study::recommended(case, 0) {
        let shown = state.shown.get(&(bits.clone(), wanted.condition))?;
        let curves = study::ComparedCurves {
            name: String::new(),
            genes: Vec::new(),
            evaluation: shown.evaluation.clone(),
            drawn: shown.curves.clone()?,
        };
        runs.push((
            wanted.condition,
            crate::cli::output::calibration::report_run(&curves),
        ));
    }
    Some(Arc::new(runs))
}

/// Curves of the recommended and the best individual so far of a calibration.
#[derive(Default)]
struct BestPictures {
    recommended: Option<Simulated>,
    best: Option<(Vec<f64>, Simulated)>,
    waiting: Option<(Vec<f64>, Awaited)>,
    asked: Option<Instant>,
}

impl BestPictures {
    fn compared(&self) -> ComparedRuns<'_> {
        let best = self.best.as_ref();
        ComparedRuns {
            recommended: self.recommended.as_ref().map(|runs| runs.as_slice()),
            best: best.map(|(genes, runs)| (genes.as_slice(), runs.as_slice())),
        }
    }

    /// Takes what has arrived, and requests the curves of a new best individual; returns whether curves have
    /// arrived.
    fn update(&mut self, shared: &Shared, opened: &OpenedRun, ended: bool) -> bool {
        if ended || !matches!(*opened.run, AnyRun::Calibration(_)) {
            return false;
        }
        let case = &opened.case;
        let mut arrived = false;
        if self.recommended.is_none() {
            self.recommended = recorded(&case.case, &shared.state.lock(), &case.case.start());
            arrived = self.recommended.is_some();
        }
        if let Some((genes, mut waiting)) = self.waiting.take() {
            match waiting.try_recv() {
                Ok(Ok(runs)) => {
                    self.best = Some((genes, runs));
                    arrived = true;
                }
                Ok(Err(_)) | Err(oneshot::error::TryRecvError::Closed) => {}
                Err(oneshot::error::TryRecvError::Empty) => self.waiting = Some((genes, waiting)),
            }
        }
        let best = shared.state.lock().best().map(|entry| entry.genes.clone());
        let shown = self.best.as_ref().map(|(genes, _)| genes);
        let rested = self.asked.is_none_or(|at| at.elapsed() >= BEST_INTERVAL);
        if let Some(best) = best.filter(|best| Some(best) != shown)
            && self.waiting.is_none()
            && rested
        {
            match shared.runs_of(case, &best) {
                Ok(known) => {
                    self.best = Some((best, known));
                    arrived = true;
                }
                Err(waiting) => self.waiting = Some((best, waiting)),
            }
            self.asked = Some(Instant::now());
        }
        arrived
    }
}

/// Pages of one run.
pub(crate) struct RunPages(Followed);

impl RunPages {
    /// Begins to follow the run in a folder, which need not exist yet.
    pub(crate) fn begin(path: &Path) -> Self {
        Self(Followed::begin(path, &Simulator::new()))
    }

    /// Returns whether the page shows the end of the run.
    pub(crate) fn has_ended(&self) -> bool {
        self.0.has_ended()
    }

    /// Ends the worker of the page's simulator, and removes its temporary run.
    pub(crate) fn close(&self) {
        self.0.shared.simulator.close();
    }
}

impl Pages for RunPages {
    fn start(&self) -> PageReader {
        self.0.reader()
    }

    fn run(&self, _name: &str) -> Option<PageReader> {
        None
    }

    async fn individual(&self, run: &str, number: u64) -> Option<String> {
        if run.is_empty() {
            self.0.individual(number).await
        } else {
            None
        }
    }
}
