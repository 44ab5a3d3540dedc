//! Measurement of the cost of silent peers on a busy coordinator: peers that connect and send nothing, or
//! open a bus session and never announce themselves. Blocks of the same run alternate without and with silent
//! peers.
//!
//! The peers are connections of a separate process, which reopens every connection that the coordinator
//! closes.
use dispatch::{
    bench::{Load, processor_time},
    runtime::{Dispatch, DispatchError, allow_connections},
};
use link::{
    WorkerEnd as _,
    locator::{Locator, Protocol},
    zenoh::ZenohWorker,
};
use serde::Serialize;
use std::{
    env, fs,
    io::{self, BufRead as _, BufReader, Read as _, Write as _},
    process::{Child, ChildStdout, Command, Stdio},
    sync::{
        Arc,
        atomic::{AtomicU64, Ordering},
    },
    time::{Duration, Instant},
};
use support::quantile;
use tokio::{
    io::{AsyncRead, AsyncReadExt as _},
    net::{TcpStream, UnixStream},
    sync::{Notify, Semaphore},
    task::JoinSet,
    time::sleep,
};

/// Duration of a measurement block, two and a half times the time for which the coordinator tolerates silent connections:
/// it closes none of them at the end of a block, where they are counted.
const BLOCK: Duration = Duration::from_secs(10);
/// Time limit for all silent connections to open, and to close.
const SETTLING: Duration = Duration::from_secs(30);
/// Maximum number of connections being opened at a time.
const OPENING: usize = 64;
/// Pause before a failed connection is retried.
const AGAIN: Duration = Duration::from_millis(50);

/// Stage of connecting at which silent peers stop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SilentStage {
    /// Peers open a connection only; the coordinator closes it when no session is opened in time.
    Connection,
    /// Peers open a bus session, which exchanges keep-alives indefinitely, but never announce themselves.
    Session,
}

/// Plan for measuring the cost of silent connections.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct SilentPlan {
    /// Stage at which the silent peers stop.
    pub(super) stage: SilentStage,
    /// Number of simultaneous silent connections.
    pub(super) connections: usize,
    /// Number of pairs of measurement blocks, one without and one with silent connections; at least one.
    pub(super) turns: usize,
}

/// Measured cost of silent connections.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub(super) struct SilentResult {
    /// Number of silent connections requested.
    pub(super) connections: usize,
    /// Smallest number of silent connections held by the coordinator at the start or end of a block.
    pub(super) held: usize,
    /// Number of times a closed connection was reopened, over all blocks.
    pub(super) reopened: u64,
    /// Number of pairs of measurement blocks, one without and one with silent connections.
    pub(super) turns: usize,
    /// Jobs per second without silent connections, median of the blocks.
    pub(super) jobs_per_s_without: f64,
    /// Jobs per second with silent connections, median of the blocks.
    pub(super) jobs_per_s_beside: f64,
    /// Ratio of the job rate with silent connections to that of the preceding block without, median \[1\].
    pub(super) rate_ratio: f64,
    /// Smallest and largest ratio of the job rates with and without silent connections \[1\].
    pub(super) rate_ratio_range: (f64, f64),
    /// Ratio of the coordinator's processor time per job with silent connections to that without, median
    /// \[1\].
    pub(super) cpu_ratio: f64,
}

/// Job rate and processor cost of one block.
#[derive(Clone, Copy, Debug)]
struct Block {
    jobs_per_s: f64,
    cpu_s_per_job: f64,
}

/// Measures an open run in blocks of time, alternately without and with silent connections.
pub(super) async fn measure(
    dispatch: &mut Dispatch,
    load: &mut Load,
    SilentPlan {
        stage,
        connections,
        turns,
    }: SilentPlan,
) -> Result<SilentResult, DispatchError> {
    let turns = turns.max(1);
    let at = dispatch.listening().into_iter().next().unwrap_or_default();
    let (mut held, mut reopened) = (connections, 0);
    let mut blocks = Vec::new();
    for _ in 0..turns {
        let own = open_files();
        let without = block(dispatch, load).await?;
        let silent = Silent::start(stage, connections, &at).map_err(DispatchError::Start)?;
        let silent = silent.opened().await.map_err(DispatchError::Start)?;
        settle(|| open_files() >= own + connections).await;
        held = held.min(open_files().saturating_sub(own));
        let beside = block(dispatch, load).await?;
        held = held.min(open_files().saturating_sub(own));
        reopened += silent.end().await.map_err(DispatchError::Start)?;
        settle(|| open_files() <= own).await;
        blocks.push((without, beside));
    }
    let each = |of: fn(&(Block, Block)) -> f64| {
        let mut all: Vec<f64> = blocks.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all
    };
    let median = |of| middle(&each(of));
    let ratios = each(|(without, beside)| beside.jobs_per_s / without.jobs_per_s);
    Ok(SilentResult {
        connections,
        held,
        reopened,
        turns,
        jobs_per_s_without: median(|(without, _)| without.jobs_per_s),
        jobs_per_s_beside: median(|(_, beside)| beside.jobs_per_s),
        rate_ratio: middle(&ratios),
        rate_ratio_range: (ratios[0], ratios[turns - 1]),
        cpu_ratio: median(|(without, beside)| beside.cpu_s_per_job / without.cpu_s_per_job),
    })
}

fn middle(sorted: &[f64]) -> f64 {
    quantile::of(sorted, 50).unwrap_or(f64::NAN)
}

async fn block(dispatch: &mut Dispatch, load: &mut Load) -> Result<Block, DispatchError> {
    let (begun, at_first, first) = (Instant::now(), processor_time(), load.submitted());
    while begun.elapsed() < BLOCK {
        let round = load.round();
        load.run(dispatch, round).await?;
    }
    let jobs = (load.submitted() - first) as f64;
    Ok(Block {
        jobs_per_s: jobs / begun.elapsed().as_secs_f64(),
        cpu_s_per_job: processor_time().saturating_sub(at_first).as_secs_f64() / jobs,
    })
}

/// Waits until `holds` returns true or [`SETTLING`] has passed; whether it did shows in the result's number
/// of connections held.
async fn settle(holds: impl Fn() -> bool) {
    let begun = Instant::now();
    while !holds() && begun.elapsed() < SETTLING {
        sleep(Duration::from_millis(20)).await;
    }
}

/// Returns the number of open file descriptors of this process, including connections.
fn open_files() -> usize {
    fs::read_dir("/proc/self/fd").map_or(0, Iterator::count)
}

/// Child process that holds silent connections, killed on drop.
struct Silent {
    process: Child,
    said: Option<BufReader<ChildStdout>>,
}

impl Silent {
    /// Starts this program as a child process with a number of silent connections to an address.
    fn start(stage: SilentStage, count: usize, connect: &str) -> io::Result<Self> {
        let mut command = Command::new(env::current_exe()?);
        command.args(["peers", "silent", connect, &count.to_string()]);
        if stage == SilentStage::Session {
            command.arg("--opened");
        }
        let mut process = command
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let said = process.stdout.take().map(BufReader::new);
        Ok(Self { process, said })
    }

    /// Waits until the child process has opened all connections.
    async fn opened(mut self) -> io::Result<Self> {
        self.next_line().await?;
        Ok(self)
    }

    /// Makes the child process close its connections; returns how many it had reopened.
    async fn end(mut self) -> io::Result<u64> {
        drop(self.process.stdin.take());
        let word = self.next_line().await?;
        word.trim().parse().map_err(io::Error::other)
    }

    /// Reads the next line of the child's standard output.
    async fn next_line(&mut self) -> io::Result<String> {
        let Some(mut said) = self.said.take() else {
            return Err(io::ErrorKind::BrokenPipe.into());
        };
        let read = tokio::task::spawn_blocking(move || {
            let mut line = String::new();
            let read = said.read_line(&mut line);
            read.map(|_| (line, said))
        });
        let (line, said) = read.await.map_err(io::Error::other)??;
        self.said = Some(said);
        Ok(line)
    }
}

impl Drop for Silent {
    fn drop(&mut self) {
        // fails only if it has ended by itself
        drop(self.process.kill());
        drop(self.process.wait());
    }
}

/// Holds a number of silent connections or sessions to an address, until standard input ends; a
/// closed connection is reopened. Prints a line to standard output when all are open, and at the end the
/// number of reopened connections.
///
/// # Errors
/// If standard output cannot be written.
pub(super) async fn keep_silent(to: &Locator, stage: SilentStage, count: usize) -> io::Result<()> {
    allow_connections();
    let opening = Arc::new(Semaphore::new(OPENING));
    let (opened, all) = (Arc::new(AtomicU64::new(0)), Arc::new(Notify::new()));
    let mut connections = JoinSet::new();
    for process in 1..=count as u64 {
        let (to, opening) = (to.clone(), Arc::clone(&opening));
        let (opened, all) = (Arc::clone(&opened), Arc::clone(&all));
        connections.spawn(async move {
            loop {
                let place = opening.acquire().await;
                let Some(held) = Held::open(stage, &to, process).await else {
                    sleep(AGAIN).await;
                    continue;
                };
                drop(place);
                if opened.fetch_add(1, Ordering::Relaxed) + 1 == count as u64 {
                    all.notify_one();
                }
                held.closed().await;
            }
        });
    }
    all.notified().await;
    let say = |line: &str| {
        let mut out = io::stdout().lock();
        writeln!(out, "{line}").and_then(|()| out.flush())
    };
    say("open")?;
    let ended = tokio::task::spawn_blocking(|| io::stdin().read_to_end(&mut Vec::new()));
    ended.await.map_err(io::Error::other)??;
    let opened = opened.load(Ordering::Relaxed);
    say(&opened.saturating_sub(count as u64).to_string())
}

/// Silent peer: a plain connection or a bus session.
enum Held {
    Connection(Box<dyn AsyncRead + Send + Unpin>),
    Session(Box<ZenohWorker>),
}

impl Held {
    /// Opens a silent peer; `None` if the connection fails.
    async fn open(stage: SilentStage, to: &Locator, process: u64) -> Option<Self> {
        match stage {
            SilentStage::Connection => {
                if to.protocol == Protocol::Unix {
                    let connection = UnixStream::connect(&to.host).await.ok()?;
                    return Some(Self::Connection(Box::new(connection)));
                }
                let address = (to.bare_host(), to.port);
                let connection = TcpStream::connect(address).await.ok()?;
                Some(Self::Connection(Box::new(connection)))
            }
            SilentStage::Session => {
                let session = ZenohWorker::open(to, None, process).await.ok()?;
                Some(Self::Session(Box::new(session)))
            }
        }
    }

    /// Waits until the coordinator closes the connection; received data are discarded.
    async fn closed(self) {
        match self {
            Self::Connection(mut connection) => {
                let mut piece = [0; 64];
                while connection
                    .read(&mut piece)
                    .await
                    .is_ok_and(|length| length > 0)
                {}
            }
            Self::Session(mut session) => while session.receive().await.is_some() {},
        }
    }
}
