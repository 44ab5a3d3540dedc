//! Rows of the scaling table that are measured on remote workers: launched by ssh for the time of the measurement, or
//! started by the user.
//!
//! The searches run one after another on the same workers, first on the largest number of them; those that a smaller
//! number leaves out are ended. Every search numbers its jobs apart from the others, so that none takes the
//! results of another.
use crate::{
    manifest::RunIdentity as _,
    message,
    scaling::{ScalingRun, ScalingSettings, Searched, file, with_times},
    session::{
        dispatcher,
        launch::{Launch, RemoteWorkers},
    },
};
use anyhow::Context as _;
use dispatch::runtime::{
    Dispatch, DispatchOptions,
    control::{messages::ControlRequest, send_request},
};
use journal::event::JobReason;
use journal::job_range::SEARCH_BITS;
use protocol::{id::JobId, job::Job};
use std::{
    collections::VecDeque,
    path::PathBuf,
    time::{Duration, Instant},
};
use study::{
    Completed, Evaluator, EvaluatorError, ProgressView, Snapshot, Stop, Watch, or_stop,
    scaling::{ScalingRow, SlotMode},
};
use support::Problem;

/// Name of the folder with the journal of the measurement, within the run folder.
const JOURNAL: &str = "remote";
/// Interval at which the number of joined workers is checked.
const POLL: Duration = Duration::from_millis(100);
/// Time without a further worker after which a measurement goes on with the launched workers that are there.
const PATIENCE: Duration = Duration::from_mins(1);

/// Measures every search on the numbers of remote workers that the settings state, as far as its rows are not stored
/// in the run folder.
///
/// # Errors
/// If the hosts cannot be reached, if no worker remains, or the user stops; stored rows are kept.
pub async fn measure(
    scale: &mut ScalingRun<'_>,
    remote: &RemoteWorkers,
    watch: &mut dyn Watch<ProgressView>,
    stop: &mut Stop,
) -> anyhow::Result<Vec<ScalingRow>> {
    let settings = &scale.run.manifest.settings;
    let searches = settings.searches();
    let mut counts = settings.nodes.clone();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    let rows = counts.iter().flat_map(|count| {
        let of = searches.iter().map(move |search| (*count, *search));
        of.collect::<Vec<(u64, Searched<'_>)>>()
    });
    let rows: Vec<(u64, Searched<'_>)> = rows.collect();
    let name = |(count, search): (u64, Searched<'_>)| file(SlotMode::Remote, search, count);
    let stored = |row: &(u64, Searched<'_>)| scale.run.folder.file(&name(*row)).exists();
    let missing = rows.iter().filter(|row| !stored(row));
    let most = missing.map(|(count, _)| *count).max();
    let mut workers = match most {
        Some(most) => Some(RemoteRun::open(scale, (remote, most), watch, stop).await?),
        None => None,
    };
    let mut measured = Vec::new();
    for (index, row) in (1..).zip(&rows) {
        let workers = &mut workers;
        let make = async |scale: &mut ScalingRun<'_>| {
            let workers = workers.as_mut().context("the remote workers are gone")?;
            workers.measure(scale, (index, *row), watch, stop).await
        };
        let made = scale.load_or_compute(&name(*row), make).await;
        match made {
            Ok(made) => measured.push(made),
            Err(error) => {
                if let Some(workers) = workers.take() {
                    workers.close().await?;
                }
                return Err(error);
            }
        }
    }
    if let Some(workers) = workers {
        workers.close().await?;
    }
    measured.sort_by_key(|row: &ScalingRow| row.slots);
    Ok(measured)
}

/// Open run with the remote workers on which searches are measured.
struct RemoteRun {
    dispatch: Dispatch,
    launch: Option<Launch>,
    journal: PathBuf,
    derivatives_over_plain: f64,
}

impl RemoteRun {
    /// Opens the run, launches the workers, and waits until `most` of them have joined and have the case.
    async fn open(
        scale: &ScalingRun<'_>,
        (remote, most): (&RemoteWorkers, u64),
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<Self> {
        let journal = scale.run.folder.file(JOURNAL);
        journal::discard(&journal).map_err(|error| Problem {
            message: error.to_string(),
            remedy: "wait for it, or choose another folder with --run DIR".to_owned(),
        })?;
        let mut launch = Launch::prepare(remote, scale.run.folder.path())?;
        let access = launch.as_ref().map_or(&remote.access, |own| &own.endpoint);
        let kind = ScalingSettings::KIND;
        let mut options =
            DispatchOptions::local(&journal, 0, &scale.run.case, kind, String::new())?;
        options.access = access.clone();
        let dispatch = dispatcher::open(options).await?;
        let launched = match &mut launch {
            Some(launch) => launch.up(),
            None => Ok(()),
        };
        let mut own = Self {
            dispatch,
            launch,
            journal,
            derivatives_over_plain: 1.0,
        };
        let ready = async {
            launched?;
            own.join(most, stop).await?;
            let slots = slots(&own.dispatch.snapshot());
            scale
                .warm_up(&mut own.dispatch, (0, slots), watch, stop)
                .await?;
            own.derivatives_over_plain = scale
                .derivatives_over_plain(&mut own.dispatch, slots)
                .await?;
            Ok(())
        };
        let ready: anyhow::Result<()> = ready.await;
        if let Err(error) = ready {
            own.close().await?;
            return Err(error);
        }
        Ok(own)
    }

    /// Waits until `wanted` workers have joined. Where hosts were named, it goes on after a while with those that have
    /// joined, at least one; workers that users start are waited for.
    async fn join(&self, wanted: u64, stop: &mut Stop) -> anyhow::Result<()> {
        let mut last = (u64::MAX, Instant::now());
        loop {
            let joined = self.dispatch.snapshot().workers.len() as u64;
            if joined >= wanted {
                return Ok(());
            }
            if joined != last.0 {
                message::print(&format!("{joined} of {wanted} remote workers have joined"));
                last = (joined, Instant::now());
            }
            if self.launch.is_some() && last.1.elapsed() > PATIENCE {
                anyhow::ensure!(joined > 0, "no remote worker joined");
                message::print(&format!(
                    "measuring with {joined} of {wanted} remote workers"
                ));
                return Ok(());
            }
            or_stop(tokio::time::sleep(POLL), stop).await?;
        }
    }

    /// Measures a search on at most `count` of the workers; `index` numbers the rows from 1.
    async fn measure(
        &mut self,
        scale: &ScalingRun<'_>,
        (index, (count, search)): (u64, (u64, Searched<'_>)),
        watch: &mut dyn Watch<ProgressView>,
        stop: &mut Stop,
    ) -> anyhow::Result<ScalingRow> {
        self.keep(count).await?;
        let slots = slots(&self.dispatch.snapshot());
        anyhow::ensure!(slots > 0, "no remote worker is left");
        let mut own = NumberedSearch {
            dispatch: &mut self.dispatch,
            first: index << SEARCH_BITS,
            times: Vec::new(),
        };
        let how = (SlotMode::Remote, search, slots);
        let row = scale.time_search(&mut own, how, watch, stop).await?;
        let times = own.times;
        Ok(with_times(row, times, self.derivatives_over_plain))
    }

    /// Ends all but the first `count` workers.
    async fn keep(&self, count: u64) -> anyhow::Result<()> {
        let present = self.dispatch.snapshot().workers;
        let names = present.into_iter().map(|row| row.worker.to_string());
        let surplus = names.skip(usize::try_from(count).unwrap_or(usize::MAX));
        let surplus: VecDeque<String> = surplus.collect();
        if surplus.is_empty() {
            return Ok(());
        }
        let request = ControlRequest::Drain {
            names: surplus.into(),
            now: true,
            end: true,
        };
        let journal = self.journal.clone();
        tokio::task::spawn_blocking(move || send_request(&journal, &request)).await??;
        let begun = Instant::now();
        while self.dispatch.snapshot().workers.len() as u64 > count {
            anyhow::ensure!(
                begun.elapsed() < PATIENCE,
                "a worker did not end when asked"
            );
            tokio::time::sleep(POLL).await;
        }
        Ok(())
    }

    /// Ends the run and the launched workers.
    async fn close(self) -> anyhow::Result<()> {
        let closed = self.dispatch.close().await;
        if let Some(launch) = self.launch {
            tokio::task::spawn_blocking(move || launch.down()).await?;
        }
        closed.map_err(EvaluatorError::from)?;
        Ok(())
    }
}

fn slots(status: &Snapshot) -> u64 {
    let workers = status.workers.iter();
    workers.map(|worker| u64::from(worker.slots)).sum()
}

/// Evaluator that numbers the jobs of one search apart from those of the others, and keeps their computing times.
struct NumberedSearch<'a> {
    dispatch: &'a mut Dispatch,
    first: u64,
    times: Vec<f64>,
}

impl Evaluator for NumberedSearch<'_> {
    fn submit(&mut self, id: JobId, job: Job, reason: JobReason) -> Result<(), EvaluatorError> {
        let id = JobId(self.first + id.0);
        Ok(self.dispatch.submit(id, job, reason)?)
    }

    fn anticipate(&mut self, jobs: Vec<Job>) -> Result<(), EvaluatorError> {
        Ok(self.dispatch.anticipate(jobs)?)
    }

    fn computes_ahead(&self) -> bool {
        self.dispatch.computes_ahead()
    }

    async fn next(&mut self) -> Result<Completed, EvaluatorError> {
        loop {
            let completed = self.dispatch.next().await?;
            // what an earlier search no longer waits for
            if let Some(id) = completed.id.0.checked_sub(self.first) {
                self.times.push(completed.cost.wall_s());
                return Ok(Completed {
                    id: JobId(id),
                    ..completed
                });
            }
        }
    }

    fn snapshot(&self) -> Snapshot {
        self.dispatch.snapshot()
    }

    async fn current_snapshot(&self) -> Result<Snapshot, EvaluatorError> {
        Ok(self.dispatch.current_snapshot().await?)
    }
}
