//! Session of a run, i.e. one process that works on it: opens the dispatcher in the run folder, does the
//! work, and records the wall time.
mod attached;
pub mod dispatcher;
pub mod interrupt;
pub mod launch;
pub mod temporary;

use self::{
    attached::AttachedDashboard,
    launch::{Launch, RemoteWorkers},
};
use crate::{manifest::RunIdentity, message, opened::Run};
use dispatch::runtime::{Dispatch, DispatchOptions};
use std::{
    cell::RefCell,
    time::{Duration, Instant},
};
use study::{EvaluatorError, Stop, StudyError};

/// Maximum number of reasons for which jobs could not be computed that a session reports.
const MOST_REASONS: usize = 3;

/// Workers of a session, and whether it shows its run in a browser.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Number of worker processes on this machine.
    pub local_workers: usize,
    /// Time for which the run waits for room on its disk, or for new workers, before it ends.
    pub pause_limit: Duration,
    /// Port at or after which the dashboard of the run listens; `None` for no dashboard.
    pub dashboard: Option<u16>,
    /// Workers of other machines.
    pub remote: RemoteWorkers,
}

/// Start time, dashboard and launched workers of a session, one process that works on a run.
pub struct Session {
    /// Time at which the command of this session began.
    started: Instant,
    /// Dashboard of the run, which ends with the command, after the result is written.
    dashboard: RefCell<Option<AttachedDashboard>>,
    /// Workers that this command launched on other hosts; they are ended with the command, after the result is
    /// written.
    launched: RefCell<Option<Launch>>,
}

impl Drop for Session {
    fn drop(&mut self) {
        if let Some(launch) = self.launched.take() {
            launch.down();
        }
    }
}

impl Session {
    /// Begins a session, whose time counts from now on.
    pub fn begin() -> Self {
        Self {
            started: Instant::now(),
            dashboard: RefCell::new(None),
            launched: RefCell::new(None),
        }
    }

    /// Returns the wall time of the run including this session (s).
    pub fn wall_s<S>(&self, run: &Run<S>) -> f64 {
        run.manifest.wall_s + self.started.elapsed().as_secs_f64()
    }

    /// Executes the work of a run with the dispatcher as evaluator, on the workers of `options`; results in the journal are not computed
    /// again. Prints at the beginning whether the run is new or resumed, and the command that resumes it if
    /// it is stopped.
    ///
    /// # Errors
    /// If the session cannot begin, or the work fails; what was computed is kept in the journal.
    pub fn work<S: RunIdentity, T>(
        &self,
        run: &Run<S>,
        options: &RunOptions,
        work: impl AsyncFnOnce(&mut Dispatch, &mut Stop) -> anyhow::Result<T>,
    ) -> anyhow::Result<T> {
        let mut launch = Launch::prepare(&options.remote, run.folder.path())?;
        let access = launch
            .as_ref()
            .map_or(&options.remote.access, |launch| &launch.endpoint)
            .clone();
        let done = dispatcher::block_on(async {
            let mut stop = interrupt::listen();
            let settings = run.manifest.settings_json()?;
            let (folder, workers) = (run.folder.path(), options.local_workers);
            let mut opening =
                DispatchOptions::local(folder, workers, &run.case, S::KIND, settings)?;
            opening.pause_limit = options.pause_limit;
            opening.access = access;
            let resumed = run.folder.is_begun();
            let mut dispatch = dispatcher::open(opening).await?;
            // the journal is ours now: before, another run may have it
            run.save(run.manifest.wall_s)?;
            let path = run.folder.path();
            if let Some(port) = options.dashboard {
                *self.dashboard.borrow_mut() = AttachedDashboard::start(path, port);
            }
            let path = path.display();
            message::print(
                &match (resumed || dispatch.recorded() > 0, dispatch.recorded()) {
                    (false, _) => format!("beginning {path}"),
                    (true, 1) => format!("going on with {path}: its journal holds 1 result"),
                    (true, recorded) => {
                        format!("going on with {path}: its journal holds {recorded} results")
                    }
                },
            );
            launch.as_mut().map_or(Ok(()), Launch::up)?;
            let done = work(&mut dispatch, &mut stop).await;
            // while the run is still locked
            let remembered = run.save(self.wall_s(run));
            let failures = failure_notes(&dispatch);
            let closed = dispatch.close().await;
            let is_stopped = |error: &anyhow::Error| {
                matches!(error.downcast_ref(), Some(StudyError::Interrupted))
            };
            if done.as_ref().map_or_else(is_stopped, |_| true) {
                for failure in failures {
                    message::print(&format!("note: {failure}"));
                }
            }
            let done = done?;
            remembered?;
            closed.map_err(EvaluatorError::from)?;
            Ok(done)
        });
        *self.launched.borrow_mut() = launch;
        done.inspect_err(|error| {
            if can_go_on(error) {
                message::print(&format!(
                    "the results so far are kept in {}; to resume the run:\n  {}",
                    run.folder.path().display(),
                    run.manifest.command
                ));
            }
        })
    }
}

/// Returns whether repeating the command after this error may add results to the run: true after an
/// interruption or an evaluator error, false if the case or the workers are at fault.
fn can_go_on(error: &anyhow::Error) -> bool {
    match error.downcast_ref::<StudyError>() {
        Some(StudyError::Evaluator(error)) => error.can_go_on,
        study => matches!(study, Some(StudyError::Interrupted)),
    }
}

/// Returns a sentence for each of the most frequent reasons for which jobs could not be computed, and one on the
/// others.
fn failure_notes(dispatch: &Dispatch) -> Vec<String> {
    let all = dispatch.failures();
    let (most, others) = all.split_at(all.len().min(MOST_REASONS));
    let sentence = |(count, reason): &&(usize, String)| match count {
        1 => format!("one simulation could not be computed: {reason}"),
        _ => format!("{count} simulations could not be computed: {reason}"),
    };
    let mut sentences: Vec<String> = most.iter().map(sentence).collect();
    let others: usize = others.iter().map(|(count, _)| count).sum();
    if others > 0 {
        sentences.push(format!(
            "{others} more could not be computed for other reasons"
        ));
    }
    sentences
}
