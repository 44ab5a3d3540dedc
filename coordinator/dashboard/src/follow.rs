//! Following of one run: its journal is read as it grows in one thread, and its page is rendered in another.
use super::{
    board::{Board, PageReader},
    sections::{self, ComparedRuns, pair},
    server::Pages,
    simulator::{Awaited, HashedCase, Simulated, Simulator},
    state::{RunState, SharedState},
};
use journal::{Growth, JournalFollower};
use protocol::case::Case;
use report::{Block, Report, Section, document::section_markup};
use run::{
    calibration::scored_curves,
    folder::{MANIFEST, RESULT, RunFolder},
    view::AnyRun,
};
use std::{
    fs,
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
    sync::{Arc, Mutex, PoisonError},
    thread,
    time::{Duration, Instant, SystemTime},
};
use study::StudyError;
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
/// Longest wait for the last results of a run whose result file is written.
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
    /// Command of a run whose results alone are shown, such as requests of another program.
    other: Mutex<Option<String>>,
    ending: Mutex<Ending>,
    simulator: Simulator,
    stopped: watch::Receiver<bool>,
}

/// End of a followed run.
#[derive(Clone, Default)]
struct Ending {
    /// Report of the finished run.
    report: Option<Arc<Report>>,
    /// Why the run cannot be followed, or its result not be shown.
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
            state.reading.log().get(number)?.genes.clone()
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
/// State of an unfinished run on which no process works.
const STOPPED: &str = "stopped";
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
            let followed = self.read();
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

    /// Reads the journal of the run as it grows, and returns the report of the finished run.
    fn read(&self) -> anyhow::Result<Report> {
        if self.opened().is_some() && !RunFolder::new(&self.path).is_begun() {
            anyhow::bail!("the run folder was deleted; what was read before stays on this page");
        }
        let folder = RunFolder::at(&self.path)?;
        let kind = folder.head()?.kind;
        let run = if AnyRun::KINDS.contains(&kind.as_str()) {
            let run = Arc::new(AnyRun::open(&self.path)?);
            *self.run.lock().unwrap_or_else(PoisonError::into_inner) = Some(OpenedRun {
                run: Arc::clone(&run),
                case: HashedCase::new(run.case())?,
            });
            Some(run)
        } else {
            *self.other.lock().unwrap_or_else(PoisonError::into_inner) = Some(kind.clone());
            None
        };
        let mut journal = JournalFollower::new(&folder.file(journal::FILE));
        // journal and result of which no report could be made
        let mut refused = None;
        loop {
            let was_finished = folder.is_finished();
            let growth = self.read_on(&mut journal)?;
            let ended = self.ended_as(&journal);
            if self.is_stopped() {
                return Err(StudyError::Interrupted.into());
            }
            let had_begun = journal.position() > 0;
            match growth {
                Growth::Replaced => anyhow::bail!("the journal was replaced by another one"),
                Growth::Missing if had_begun || !folder.is_begun() => {
                    anyhow::bail!("the run folder was deleted")
                }
                Growth::Unchanged if was_finished && refused != Some(ended) => {
                    match self.report(&folder, &kind, run.as_deref()) {
                        Ok(report) => return Ok(report),
                        Err(error) => self.end(Ending {
                            report: None,
                            error: Some(format!("{error:#}")),
                        }),
                    }
                    refused = Some(ended);
                }
                // what was missing is being computed again
                Growth::Grown if refused.is_some() => {
                    self.end(Ending::default());
                    refused = None;
                }
                Growth::Missing | Growth::Unchanged | Growth::Grown => {}
            }
            thread::sleep(INTERVAL);
        }
    }

    /// Returns the position up to which the journal was read, and the stamp of the result file.
    fn ended_as(&self, journal: &JournalFollower) -> (u64, (u64, u64)) {
        (journal.position(), stamp(&self.path.join(RESULT)))
    }

    /// Reads what was appended to the journal. Before the first event it forgets what was known, and why the run could
    /// not be followed before.
    fn read_on(&self, journal: &mut JournalFollower) -> anyhow::Result<Growth> {
        let mut is_first = journal.position() == 0;
        let growth = journal.read(|_, event| {
            if is_first {
                self.state.clear();
                self.end(Ending::default());
                is_first = false;
            }
            self.state.event(event);
        })?;
        if growth == Growth::Grown {
            self.state.damage(journal.damage());
        }
        Ok(growth)
    }

    /// Returns the report of a finished run; of a run of another kind, such as requests of another program, its results and workers.
    fn report(
        &self,
        folder: &RunFolder,
        kind: &str,
        run: Option<&AnyRun>,
    ) -> anyhow::Result<Report> {
        let Some(run) = run else {
            let title = sections::other_title(kind, &self.path);
            let sections = sections::other(kind, &self.state.lock());
            return Ok(Report::new(title, "", sections));
        };
        let result: serde_json::Value = folder.read_json(RESULT)?;
        run.report(result["wall_s"].as_f64().unwrap_or_default())
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
                let failed = (word == STOPPED).then(|| state.reading.failure()).flatten();
                let failed = failed.map(|error| error.to_string());
                let error = ending.error.as_deref().or(lacking).or(failed.as_deref());
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
            STOPPED.to_owned()
        }
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
    let run = |condition: usize| {
        let curves = state.reading.compared(condition, genes)?;
        Some((condition, scored_curves(&curves)))
    };
    let wanted = study::recommended(case, 0).into_iter();
    let runs: Option<Vec<_>> = wanted.map(|own| run(own.condition)).collect();
    Some(Arc::new(runs?))
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
pub struct RunPages(Followed);

impl RunPages {
    /// Begins to follow the run in a folder, which need not exist yet.
    pub fn begin(path: &Path) -> Self {
        Self(Followed::begin(path, &Simulator::new()))
    }

    /// Returns whether the page shows the end of the run.
    pub fn has_ended(&self) -> bool {
        self.0.has_ended()
    }

    /// Ends the worker of the page's simulator, and removes its temporary run.
    pub fn close(&self) {
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
