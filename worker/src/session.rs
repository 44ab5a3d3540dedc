//! A worker's life on the bus: announce, take jobs, return results, until told to end.
mod case;
mod proof;
mod state;

use crate::{
    convert, handler,
    pool::{Pool, SlotOptions},
};
use link::WorkerEnd;
use protocol::{announce::Announcement, id::WorkerId, job::kind, wire};
use state::{State, Step};
use std::{
    future::Future,
    io,
    path::PathBuf,
    thread,
    time::{Duration, Instant},
};
use tokio::sync::mpsc::unbounded_channel;

/// How often the session looks after itself.
const TICK: Duration = Duration::from_millis(250);

/// How long a worker waits to be told that its leaving was heard.
const FAREWELL: Duration = Duration::from_millis(500);

/// How a session is set up.
#[derive(Clone, Debug)]
pub struct SessionOptions {
    /// The worker's name.
    pub id: WorkerId,
    /// Jobs computed at a time.
    pub slots: usize,
    /// Program whose `slot` subcommand computes; usually this one.
    pub program: PathBuf,
    /// Address space that a slot's process may have (MiB); 0 for as much as there is.
    pub slot_memory_mib: u64,
    /// Without work for so long the worker ends; never by default.
    pub idle_timeout: Option<Duration>,
    /// Whether it belongs to one coordinator and ends with its run.
    pub embedded: bool,
}

/// Why a session ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// It was asked to.
    Asked,
    /// The run is over and the worker belongs to it.
    RunOver,
    /// There was no work for the given time.
    Idle,
    /// The coordinator does not take it.
    Refused(String),
    /// The link is closed.
    Unlinked,
}

/// Serves until there is a reason to end; `asked` is that of the outside.
///
/// # Errors
/// If the slots cannot be started.
pub async fn run<L: WorkerEnd>(
    mut link: L,
    options: SessionOptions,
    asked: impl Future<Output = ()> + Send,
) -> io::Result<Ending> {
    let (to, mut freed) = unbounded_channel();
    let slot = SlotOptions {
        program: options.program.clone(),
        memory_mib: options.slot_memory_mib,
    };
    let pool = Pool::start(options.slots, &slot, &to)?;
    let begun = Instant::now();
    let mut state = State::new(options, announcement, pool);
    let mut ticks = tokio::time::interval(TICK);
    ticks.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    let mut asked = std::pin::pin!(asked);
    let ending = loop {
        let step = tokio::select! {
            frame = link.receive() => match frame {
                Some(frame) => state.hear(&mut link, &frame, begun.elapsed()).await,
                None => Step::End(Ending::Unlinked),
            },
            Some(freed) = freed.recv() => state.freed(&mut link, freed, begun.elapsed()),
            Some(piece) = state.fetching.join_next() => state.piece(&mut link, piece),
            _ = ticks.tick() => state.tick(&mut link, begun.elapsed()),
            () = &mut asked => Step::End(Ending::Asked),
        };
        if let Step::End(ending) = step {
            break ending;
        }
    };
    if state.leave(&mut link, &ending) {
        let heard = tokio::time::timeout(FAREWELL, state.dismissed(&mut link)).await;
        tracing::debug!(answered = heard.is_ok(), "left");
    }
    // ends the slots, which takes a moment and would hold up the link
    let ended = tokio::task::spawn_blocking(move || drop(state));
    link.close().await;
    ended.await.map_err(io::Error::other)?;
    Ok(ending)
}

fn announcement(slots: usize) -> Announcement {
    let profile = if cfg!(debug_assertions) {
        "debug"
    } else {
        "release"
    };
    Announcement {
        protocol: wire::VERSION,
        build: format!("{} {profile}", env!("CARGO_PKG_VERSION")),
        model_digest: handler::model_digest().to_owned(),
        host: rustix::system::uname()
            .nodename()
            .to_string_lossy()
            .into_owned(),
        pid: std::process::id(),
        slots: u32::try_from(slots).unwrap_or(u32::MAX),
        cores: thread::available_parallelism()
            .map_or(0, |cores| u32::try_from(cores.get()).unwrap_or(u32::MAX)),
        job_kinds: kind::ALL.map(str::to_owned).to_vec(),
        effects: convert::effect::descriptors(),
    }
}
