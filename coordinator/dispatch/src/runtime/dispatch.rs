//! Handle of an open run, used by the caller that submits jobs.
use super::{
    control::Control,
    divide::Divide,
    engine::{Engine, Request, RunSummary},
    error::DispatchError,
    listen::{Addresses, addresses, admissible, allow_connections, keys},
    local::LocalWorkers,
    locate,
    options::DispatchOptions,
    parts::Parts,
};
use crate::scheduler::{Completed, Snapshot};
use journal::{StudyEntries, event::JobReason};
use link::{
    Blob, CoordinatorEnd,
    locator::Locator,
    zenoh::{CoordinatorOptions, ZenohCoordinator},
};
use protocol::{
    id::{ContentHash, JobId, RunId},
    job::{Job, Outcome},
};
use std::{
    cmp::Reverse,
    collections::BTreeMap,
    path::PathBuf,
    sync::{Arc, Mutex, PoisonError},
};
use tempfile::TempDir;
use tokio::{
    sync::{
        mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel},
        oneshot,
    },
    task::JoinHandle,
};

/// Handle of an open run.
#[derive(Debug)]
pub struct Dispatch {
    requests: UnboundedSender<Request>,
    completed: UnboundedReceiver<Result<Completed, DispatchError>>,
    divide: Arc<dyn Divide>,
    /// Submitted divisible jobs that wait for the next call of [`Self::next`], when all jobs that can be
    /// computed at the same time are known.
    divisible: Vec<(JobId, Job, JobReason)>,
    /// Contents of the jobs anticipated last.
    anticipated: Vec<ContentHash>,
    entries: StudyEntries,
    snapshot: Arc<Mutex<Snapshot>>,
    engine: JoinHandle<RunSummary>,
    listening: Vec<Locator>,
    recorded: usize,
    /// Run folder with the journal.
    run_dir: PathBuf,
    /// Number of jobs that could not be computed and the first of their reasons, by the first line of the reason.
    failures: BTreeMap<String, (usize, String)>,
    /// Control socket of the run; `None` if it could not be opened.
    control: Option<Control>,
    /// Folder of the socket for local workers, deleted with this value; `None` if none was made.
    socket_folder: Option<TempDir>,
}

impl Dispatch {
    /// Opens or continues the journal, and opens the bus and the local workers.
    ///
    /// # Errors
    /// [`DispatchError::Journal`] if the run cannot be written or was begun with other settings,
    /// [`DispatchError::Link`] if the address cannot be listened on, [`DispatchError::Locate`] if there is no
    /// worker program, [`DispatchError::NoWorkers`] without any workers.
    pub async fn open(options: DispatchOptions) -> Result<Self, DispatchError> {
        let Addresses {
            listen,
            local,
            folder,
        } = addresses(&options)?;
        allow_connections();
        // a folder that was made for a run that cannot begin would only be in the way
        for locator in &listen {
            admissible(locator, options.access.insecure)?;
        }
        let keys = keys(&options, &listen)?;
        let program = match &local {
            Some(_) => Some(locate::worker_program()?),
            None => None,
        };
        let (parts, entries) = Parts::open(&options)?;
        let (run, blob) = (parts.run, parts.blob.clone());
        let insecure = options.access.insecure;
        let link_options = CoordinatorOptions {
            listen,
            insecure,
            keys,
            run,
            blob,
        };
        let link = ZenohCoordinator::open(link_options).await?;
        let listening = link.listening().to_vec();
        let workers = match (local, program) {
            (Some(locator), Some(program)) => {
                let count = options.local_workers;
                Some(LocalWorkers::start(program, &locator, count)?)
            }
            _ => None,
        };
        let only_local = options.access.listen.is_none();
        let run_dir = options.run_dir.clone();
        let mut open = Self::begin((parts, entries), link, workers, only_local, run_dir);
        open.listening = listening;
        open.socket_folder = folder;
        // a sender of its own would keep the run open for ever
        let requests = open.requests.downgrade();
        let ask = move |asked| {
            let requests = requests.upgrade();
            requests.is_some_and(|requests| requests.send(Request::Control(asked)).is_ok())
        };
        open.control = Control::open(&options.run_dir, ask)
            .inspect_err(|error| {
                tracing::warn!("the control socket cannot be opened, so `horsehead workers` commands do not work for this run: {error}");
            })
            .ok();
        Ok(open)
    }

    /// Opens a run over the link that `make` creates from the run's identifier and the data that workers may
    /// fetch, without local workers. `options.access.listen`, `insecure` and `local_workers` are not used.
    ///
    /// # Errors
    /// [`DispatchError::Journal`] as [`Self::open`].
    pub fn over<L: CoordinatorEnd>(
        options: &DispatchOptions,
        make: impl FnOnce(RunId, Blob) -> L,
    ) -> Result<Self, DispatchError> {
        let (parts, entries) = Parts::open(options)?;
        let link = make(parts.run, parts.blob.clone());
        let run_dir = options.run_dir.clone();
        Ok(Self::begin((parts, entries), link, None, false, run_dir))
    }

    fn begin<L: CoordinatorEnd>(
        (parts, entries): (Parts, StudyEntries),
        link: L,
        workers: Option<LocalWorkers>,
        only_local: bool,
        run_dir: PathBuf,
    ) -> Self {
        let recorded = parts.journal.len();
        let divide = Arc::clone(&parts.divide);
        let (requests, asked) = unbounded_channel();
        let (deliver, completed) = unbounded_channel();
        let snapshot = Arc::new(Mutex::new(Snapshot::default()));
        let shown = Arc::clone(&snapshot);
        let engine = Engine::new(parts, link, workers, only_local, deliver, shown);
        let engine = tokio::spawn(engine.run(asked));
        Self {
            requests,
            completed,
            divide,
            divisible: Vec::new(),
            anticipated: Vec::new(),
            entries,
            snapshot,
            engine,
            listening: Vec::new(),
            recorded,
            run_dir,
            failures: BTreeMap::new(),
            control: None,
            socket_folder: None,
        }
    }

    /// Returns the number of results that the journal held when the run was opened.
    pub const fn recorded(&self) -> usize {
        self.recorded
    }

    /// Returns the addresses on which workers can connect; the first is the requested one.
    pub fn listening(&self) -> Vec<String> {
        self.listening.iter().map(ToString::to_string).collect()
    }

    /// Submits a job, with the reason that the journal states; each id may be submitted once per process and is below 2^63. A result that the journal already
    /// holds is delivered at once. A divisible job is sent to workers by the next call of [`Self::next`], in
    /// parts where slots would be idle.
    ///
    /// # Errors
    /// [`DispatchError::Closed`] once the run has been stopped.
    pub fn submit(&mut self, id: JobId, job: Job, reason: JobReason) -> Result<(), DispatchError> {
        if self.divide.units(&job) > 1 {
            self.divisible.push((id, job, reason));
            return Ok(());
        }
        let asked = Request::Submit(vec![(id, job, reason)]);
        self.requests.send(asked).map_err(|_| DispatchError::Closed)
    }

    /// Records the study's next entry: what it found or concluded. One that an earlier process of the run recorded is
    /// compared with it and not written twice.
    ///
    /// # Errors
    /// [`DispatchError::Journal`] if the recorded entry is another one, [`DispatchError::Closed`] once the run has been
    /// stopped.
    pub fn record(&mut self, entry: Vec<u8>) -> Result<(), DispatchError> {
        let Some(event) = self.entries.enter(entry)? else {
            return Ok(());
        };
        let asked = self.requests.send(Request::Record(event));
        asked.map_err(|_| DispatchError::Closed)
    }

    /// Replaces the jobs that the run will probably submit next, likeliest first. Slots that would be idle compute
    /// them ahead; once such a job is submitted, what has been computed of it is used. No effect on results.
    ///
    /// # Errors
    /// [`DispatchError::Closed`] once the run has been stopped.
    pub fn anticipate(&mut self, jobs: Vec<Job>) -> Result<(), DispatchError> {
        let works: Vec<ContentHash> = jobs.iter().map(Job::work_hash).collect();
        if works == self.anticipated {
            return Ok(());
        }
        self.anticipated = works;
        self.send_divisible()?;
        let asked = self.requests.send(Request::Anticipate(jobs));
        asked.map_err(|_| DispatchError::Closed)
    }

    /// Sends the submitted divisible jobs to the engine.
    fn send_divisible(&mut self) -> Result<(), DispatchError> {
        if self.divisible.is_empty() {
            return Ok(());
        }
        let jobs = std::mem::take(&mut self.divisible);
        let asked = self.requests.send(Request::Submit(jobs));
        asked.map_err(|_| DispatchError::Closed)
    }

    /// Waits for the next job result, in the order of arrival. Cancel safe.
    ///
    /// # Errors
    /// The reason why the run cannot go on; afterwards only [`Self::close`] is useful.
    pub async fn next(&mut self) -> Result<Completed, DispatchError> {
        self.send_divisible()?;
        let completed = self.completed.recv().await;
        let completed = completed.unwrap_or(Err(DispatchError::Closed))?;
        if let Outcome::Failed(failure) = &completed.outcome {
            let reason = failure.to_string();
            // what a program printed may differ from run to run
            let first = reason.lines().next().unwrap_or_default().to_owned();
            self.failures.entry(first).or_insert((0, reason)).0 += 1;
        }
        Ok(completed)
    }

    /// Returns how many of the jobs returned by [`Self::next`] could not be computed for the same reason, with the words
    /// of the first, the most frequent reason first. Reasons are the same where their first lines are.
    pub fn failures(&self) -> Vec<&(usize, String)> {
        let mut all: Vec<_> = self.failures.values().collect();
        all.sort_by_key(|(count, _)| Reverse(*count));
        all
    }

    /// Returns the path of the run's journal.
    pub fn journal(&self) -> PathBuf {
        self.run_dir.join(journal::FILE)
    }

    /// Returns the state of the run (jobs, workers, slot time), at most some hundredths of a second old.
    pub fn snapshot(&self) -> Snapshot {
        self.snapshot
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Returns the state of the run as of now, after every result that [`Self::next`] has returned. Slower than
    /// [`Self::snapshot`].
    ///
    /// # Errors
    /// [`DispatchError::Closed`] once the run has been stopped.
    pub async fn current_snapshot(&self) -> Result<Snapshot, DispatchError> {
        let (to, snapshot) = oneshot::channel();
        let asked = self.requests.send(Request::Snapshot(to));
        asked.map_err(|_| DispatchError::Closed)?;
        snapshot.await.map_err(|_| DispatchError::Closed)
    }

    /// Returns whether some slot had no job when the last snapshot was taken, or computed a job ahead.
    pub fn has_idle_slots(&self) -> bool {
        let snapshot = self.snapshot.lock().unwrap_or_else(PoisonError::into_inner);
        !self.anticipated.is_empty() || snapshot.idle > 0
    }

    /// Ends the run: tells workers, ends local workers and closes the journal, within 3 s. On a full disk it
    /// waits for room, since workers discard their results at the end of a run. The same run can be opened
    /// again later.
    ///
    /// # Errors
    /// [`DispatchError::Closed`] if the runtime failed before.
    pub async fn close(self) -> Result<RunSummary, DispatchError> {
        // an engine that has stopped needs no request
        drop(self.requests);
        drop(self.control);
        let ended = self.engine.await;
        // only now: the link deletes its socket
        drop(self.socket_folder);
        ended.map_err(|_| DispatchError::Closed)
    }
}
