//! Worker processes on this machine: started, restarted within limits, ended.
//!
//! A job may crash its worker, and the next worker too; the core gives such a job up. A worker that ends is
//! therefore restarted as long as the run makes progress, and given up only after several exits without a
//! result in between.
//!
//! One thread owns all workers and lives as long as they do, because the parent-death signal that ends them
//! is bound to the thread that started them. Workers also end when their standard input does.
use super::error::DispatchError;
use link::locator::Locator;
use std::{
    collections::BTreeSet,
    io::{self, BufRead, BufReader, Read, Write},
    os::unix::process::{CommandExt, ExitStatusExt},
    path::PathBuf,
    process::{Child, ChildStderr, Command, ExitStatus, Stdio},
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicU64, Ordering},
        mpsc,
    },
    thread,
    time::{Duration, Instant},
};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

/// Interval at which the state of local worker processes is polled.
const LOOK: Duration = Duration::from_millis(50);
/// Maximum number of restarts of a local worker while the run gets no result; more than the number of crashes
/// after which the scheduler core gives up a job.
const RESTARTS: u32 = 8;
/// Running time after which a worker's restart count is reset.
const WORKED: Duration = Duration::from_mins(1);
/// Exit status of a worker that was refused or told to end; a restart would fail again.
const REFUSED: i32 = 3;
/// Pause before the first restart of a local worker; doubled for each further one up to [`LONGEST_PAUSE`].
const PAUSE: Duration = Duration::from_millis(100);
/// Longest pause before a local worker is restarted.
const LONGEST_PAUSE: Duration = Duration::from_millis(800);
/// Time limit for workers to end by themselves before they are killed.
const PATIENCE: Duration = Duration::from_millis(1500);
/// Time limit for reading the last output of a worker that has ended: its child processes may still hold the
/// pipe.
const LAST_WORDS: Duration = Duration::from_millis(200);
/// Maximum length of a worker's output that is forwarded as one line (bytes).
const LONGEST_LINE: u64 = 64 << 10;

/// Event of the local worker processes: one ended, one was given up, or all were; each with a description of
/// the exit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum LocalEvent {
    Ended { how: String },
    GivenUp { how: String },
    AllGivenUp { how: String },
}

/// Worker processes on this machine; on drop they are ended and waited for.
#[derive(Debug)]
pub(super) struct LocalWorkers {
    events: UnboundedReceiver<LocalEvent>,
    /// Number of results of the run from any worker.
    results: Arc<AtomicU64>,
    /// Ids of all processes that were started.
    started: Arc<Mutex<BTreeSet<u32>>>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<thread::JoinHandle<()>>,
}

impl LocalWorkers {
    /// Starts `count` local worker processes with one slot each.
    pub(super) fn start(
        path: PathBuf,
        connect: &Locator,
        count: usize,
    ) -> Result<Self, DispatchError> {
        let (say, events) = unbounded_channel();
        let (end, ended) = mpsc::channel();
        let (begun_to, begun) = mpsc::channel();
        let program = Program {
            path,
            connect: connect.to_string(),
            started: Arc::default(),
        };
        let started = Arc::clone(&program.started);
        let results = Arc::new(AtomicU64::new(0));
        let progress = Arc::clone(&results);
        let tend = move || {
            let mut places = Vec::new();
            // the first one shows whether it can be done; nobody should wait for hundreds more,
            // and none is started once the end is asked for
            while places.len() < count && matches!(ended.try_recv(), Err(mpsc::TryRecvError::Empty))
            {
                match LocalWorker::start(&program) {
                    Ok(place) => places.push(place),
                    Err(error) if places.is_empty() => {
                        drop(begun_to.send(Err(error)));
                        return;
                    }
                    Err(error) => {
                        tracing::warn!(
                            "only {} of {count} local workers can be started: {error}",
                            places.len()
                        );
                        break;
                    }
                }
                if places.len() == 1 {
                    drop(begun_to.send(Ok(())));
                }
            }
            supervise(&mut places, &program, &progress, &say, &ended);
            end_all(places);
        };
        let thread = thread::Builder::new()
            .name("local-workers".to_owned())
            .spawn(tend)
            .map_err(DispatchError::Start)?;
        match begun.recv() {
            Ok(Ok(())) => Ok(Self {
                events,
                results,
                started,
                end: Some(end),
                thread: Some(thread),
            }),
            Ok(Err(error)) => Err(DispatchError::Start(error)),
            Err(_) => Err(DispatchError::Closed),
        }
    }

    /// Notes the number of results so far; results show that restarting local workers is worthwhile.
    pub(super) fn note_results(&self, results: u64) {
        self.results.store(results, Ordering::Relaxed);
    }

    /// Returns whether a process of this machine is one of the local workers.
    pub(super) fn has_started(&self, process: u32) -> bool {
        let started = self.started.lock().unwrap_or_else(PoisonError::into_inner);
        started.contains(&process)
    }

    /// Waits for the next event of a local worker. Cancel safe.
    pub(super) async fn event(&mut self) -> Option<LocalEvent> {
        self.events.recv().await
    }
}

impl Drop for LocalWorkers {
    fn drop(&mut self) {
        self.end = None;
        if let Some(thread) = self.thread.take()
            && thread.join().is_err()
        {
            tracing::error!("the thread of the local workers panicked");
        }
    }
}

/// Worker program with the coordinator's address to which it connects, and the processes that it became.
struct Program {
    path: PathBuf,
    connect: String,
    /// Ids of all processes that were started.
    started: Arc<Mutex<BTreeSet<u32>>>,
}

/// Standard error of a worker, forwarded line by line; the last line is kept.
struct WorkerOutput {
    last: Arc<Mutex<String>>,
    /// Channel that is disconnected when the worker's output ends.
    over: mpsc::Receiver<()>,
}

impl WorkerOutput {
    fn listen(output: ChildStderr) -> io::Result<Self> {
        let last = Arc::new(Mutex::new(String::new()));
        let (open, over) = mpsc::channel();
        let keep = Arc::clone(&last);
        let pass = move || {
            let _open: mpsc::Sender<()> = open;
            let mut output = BufReader::new(output);
            let mut line = Vec::new();
            while (&mut output)
                .take(LONGEST_LINE)
                .read_until(b'\n', &mut line)
                .is_ok_and(|count| count > 0)
            {
                // a closed output of this program is no reason to stop reading: the worker would block
                drop(io::stderr().write_all(&line));
                let text = String::from_utf8_lossy(&line);
                if !text.trim().is_empty() {
                    text.trim()
                        .clone_into(&mut keep.lock().unwrap_or_else(PoisonError::into_inner));
                }
                line.clear();
            }
        };
        let builder = thread::Builder::new().name("worker-output".to_owned());
        builder.stack_size(64 << 10).spawn(pass)?;
        Ok(Self { last, over })
    }

    /// Returns the last line of output of a worker that has ended; empty if there was none.
    fn last(&self) -> String {
        // nothing is ever sent: either the output ends, or the time is up
        self.over.recv_timeout(LAST_WORDS).unwrap_or_default();
        let last = self.last.lock().unwrap_or_else(PoisonError::into_inner);
        last.clone()
    }
}

/// Worker process on this machine, with its restart history.
struct LocalWorker {
    child: Option<Child>,
    said: WorkerOutput,
    begun: Instant,
    /// Number of results of the run at the last exit of the worker.
    results: u64,
    /// Number of consecutive exits of the worker without a result of the run in between.
    restarts: u32,
    /// Whether the worker ended because the coordinator refused it.
    refused: bool,
    pause: Duration,
    again_at: Option<Instant>,
}

impl LocalWorker {
    fn start(program: &Program) -> io::Result<Self> {
        let mut child = Command::new(&program.path)
            .args(["--connect", &program.connect, "--slots", "1", "--embedded"])
            .env_remove("HORSEHEAD_IDLE_TIMEOUT")
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::piped())
            // out of reach of Ctrl-C, which is for the coordinator to handle
            .process_group(0)
            .spawn()?;
        let started = &program.started;
        let mut started = started.lock().unwrap_or_else(PoisonError::into_inner);
        started.insert(child.id());
        drop(started);
        let output = child.stderr.take();
        let said = WorkerOutput::listen(output.ok_or(io::ErrorKind::BrokenPipe)?)?;
        Ok(Self {
            child: Some(child),
            said,
            begun: Instant::now(),
            results: 0,
            restarts: 0,
            refused: false,
            pause: PAUSE,
            again_at: None,
        })
    }

    /// Returns a description of the exit if the worker process has ended since the last call.
    fn ended(&mut self) -> Option<String> {
        let how = match self.child.as_mut()?.try_wait() {
            Ok(None) => return None,
            Ok(Some(status)) => {
                self.refused = status.code() == Some(REFUSED);
                let how = words(status);
                match self.said.last() {
                    last if last.is_empty() => how,
                    last => format!("{how}: `{last}`"),
                }
            }
            Err(error) => format!("could not be checked: {error}"),
        };
        self.child = None;
        if self.begun.elapsed() >= WORKED {
            (self.restarts, self.pause) = (0, PAUSE);
        }
        Some(how)
    }

    /// Schedules a restart of a worker that ended, or gives it up; `results` is the run's current number of
    /// results.
    fn schedule_restart(&mut self, how: String, results: u64) -> LocalEvent {
        if results > self.results {
            (self.results, self.restarts) = (results, 0);
        }
        if self.refused || self.restarts == RESTARTS {
            return LocalEvent::GivenUp { how };
        }
        self.restarts += 1;
        self.again_at = Some(Instant::now() + self.pause);
        self.pause = (self.pause * 2).min(LONGEST_PAUSE);
        LocalEvent::Ended { how }
    }

    /// Restarts the worker if its pause is over; returns the error if that fails.
    fn restart_when_due(&mut self, program: &Program) -> Option<String> {
        self.again_at.filter(|at| *at <= Instant::now())?;
        self.again_at = None;
        match Self::start(program) {
            Ok(started) => {
                (self.child, self.said, self.begun) = (started.child, started.said, started.begun);
                None
            }
            Err(error) => Some(format!("cannot be started again: {error}")),
        }
    }
}

fn supervise(
    places: &mut [LocalWorker],
    program: &Program,
    results: &AtomicU64,
    say: &UnboundedSender<LocalEvent>,
    end: &mpsc::Receiver<()>,
) {
    let (count, mut given_up) = (places.len(), 0);
    while matches!(end.recv_timeout(LOOK), Err(mpsc::RecvTimeoutError::Timeout)) {
        for place in &mut *places {
            let results = results.load(Ordering::Relaxed);
            let ended = place
                .ended()
                .map(|how| place.schedule_restart(how, results));
            let restarted = place.restart_when_due(program);
            let failed = restarted.map(|error| place.schedule_restart(error, results));
            for event in ended.into_iter().chain(failed) {
                let gone = match &event {
                    LocalEvent::GivenUp { how } => Some(how.clone()),
                    LocalEvent::Ended { .. } | LocalEvent::AllGivenUp { .. } => None,
                };
                drop(say.send(event));
                given_up += usize::from(gone.is_some());
                if let Some(how) = gone.filter(|_| given_up == count) {
                    drop(say.send(LocalEvent::AllGivenUp { how }));
                    // waits for the end
                    end.recv().unwrap_or_default();
                    return;
                }
            }
        }
    }
}

/// Ends workers by closing their standard input, and kills those that do not end in time.
fn end_all(places: Vec<LocalWorker>) {
    let mut children: Vec<Child> = places.into_iter().filter_map(|place| place.child).collect();
    for child in &mut children {
        // the end of its input is what it listens for
        drop(child.stdin.take());
    }
    let until = Instant::now() + PATIENCE;
    while Instant::now() < until {
        children.retain_mut(|child| matches!(child.try_wait(), Ok(None)));
        if children.is_empty() {
            return;
        }
        thread::sleep(Duration::from_millis(5));
    }
    for mut child in children {
        // fails only if it has ended by itself after all
        drop(child.kill());
        drop(child.wait());
    }
}

fn words(status: ExitStatus) -> String {
    match (status.signal(), status.code()) {
        (Some(signal), _) => format!("was ended by signal {signal}"),
        (None, Some(code)) => format!("ended with status {code}"),
        (None, None) => "ended without a status".to_owned(),
    }
}
