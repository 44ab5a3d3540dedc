//! Worker processes on this machine: started, restarted within limits, ended.
//!
//! One thread owns them all and lives as long as they do, because the parent-death signal that
//! ends them follows the thread that started them. They also end when their standard input does.
use super::DispatchError;
use link::locator::Locator;
use std::{
    io,
    os::unix::process::{CommandExt, ExitStatusExt},
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    sync::mpsc,
    thread,
    time::{Duration, Instant},
};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};

/// How often the processes are looked at.
const LOOK: Duration = Duration::from_millis(50);
/// Restarts of one worker in a row.
const RESTARTS: u32 = 5;
/// After so long a worker counts as having worked.
const WORKED: Duration = Duration::from_mins(1);
/// How long they may take to end by themselves.
const PATIENCE: Duration = Duration::from_millis(1500);

/// What happened to local workers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum LocalEvent {
    Ended { how: String },
    GivenUp { how: String },
    AllGivenUp { how: String },
}

/// Local workers; dropping it ends them and waits for their end.
#[derive(Debug)]
pub(super) struct LocalWorkers {
    events: UnboundedReceiver<LocalEvent>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<thread::JoinHandle<()>>,
}

impl LocalWorkers {
    /// Starts `count` workers with one slot each.
    pub(super) fn start(
        program: PathBuf,
        connect: &Locator,
        count: usize,
    ) -> Result<Self, DispatchError> {
        let (say, events) = unbounded_channel();
        let (end, ended) = mpsc::channel();
        let (begun_to, begun) = mpsc::channel();
        let connect = connect.to_string();
        let tend = move || {
            let mut places = Vec::new();
            // the first one shows whether it can be done; nobody should wait for hundreds more,
            // and none is started once the end is asked for
            while places.len() < count && matches!(ended.try_recv(), Err(mpsc::TryRecvError::Empty))
            {
                match Place::start(&program, &connect) {
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
            tend(&mut places, &program, &connect, &say, &ended);
            end_all(places);
        };
        let thread = thread::Builder::new()
            .name("local-workers".to_owned())
            .spawn(tend)
            .map_err(DispatchError::Start)?;
        match begun.recv() {
            Ok(Ok(())) => Ok(Self {
                events,
                end: Some(end),
                thread: Some(thread),
            }),
            Ok(Err(error)) => Err(DispatchError::Start(error)),
            Err(_) => Err(DispatchError::Closed),
        }
    }

    /// Waits for the next thing that happens; loses nothing when dropped.
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

/// One worker and its history.
struct Place {
    child: Option<Child>,
    begun: Instant,
    restarts: u32,
    again_at: Option<Instant>,
}

impl Place {
    fn start(program: &Path, connect: &str) -> io::Result<Self> {
        let child = Command::new(program)
            .args(["--connect", connect, "--slots", "1", "--embedded"])
            .env_remove("HORSEHEAD_IDLE_TIMEOUT")
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            // out of reach of Ctrl-C, which is for the coordinator to handle
            .process_group(0)
            .spawn()?;
        Ok(Self {
            child: Some(child),
            begun: Instant::now(),
            restarts: 0,
            again_at: None,
        })
    }

    /// How it ended, if it just did.
    fn ended(&mut self) -> Option<String> {
        let how = match self.child.as_mut()?.try_wait() {
            Ok(None) => return None,
            Ok(Some(status)) => words(status),
            Err(error) => format!("is out of sight: {error}"),
        };
        self.child = None;
        if self.begun.elapsed() >= WORKED {
            self.restarts = 0;
        }
        Some(how)
    }
}

fn tend(
    places: &mut [Place],
    program: &Path,
    connect: &str,
    say: &UnboundedSender<LocalEvent>,
    ended: &mpsc::Receiver<()>,
) {
    let mut given_up = 0;
    while matches!(
        ended.recv_timeout(LOOK),
        Err(mpsc::RecvTimeoutError::Timeout)
    ) {
        for place in &mut *places {
            if let Some(how) = place.ended() {
                let event = if place.restarts < RESTARTS {
                    let pause = Duration::from_millis(100) * 2_u32.pow(place.restarts);
                    place.again_at = Some(Instant::now() + pause);
                    LocalEvent::Ended { how }
                } else {
                    given_up += 1;
                    LocalEvent::GivenUp { how }
                };
                drop(say.send(event));
            }
            if place.again_at.is_some_and(|at| at <= Instant::now()) {
                restart(place, program, connect);
            }
        }
        if given_up == places.len() {
            let how = "ended too often".to_owned();
            drop(say.send(LocalEvent::AllGivenUp { how }));
            // waits for the end
            ended.recv().unwrap_or_default();
            return;
        }
    }
}

fn restart(place: &mut Place, program: &Path, connect: &str) {
    let restarts = place.restarts + 1;
    match Place::start(program, connect) {
        Ok(started) => {
            *place = Place {
                restarts,
                ..started
            }
        }
        Err(error) => {
            tracing::warn!("a local worker cannot be restarted: {error}");
            place.restarts = restarts;
            place.again_at = (restarts < RESTARTS).then(|| Instant::now() + Duration::from_secs(1));
        }
    }
}

/// Lets them end by themselves, then makes them.
fn end_all(places: Vec<Place>) {
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
