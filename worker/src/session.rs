//! Session of a worker on the bus: announces the worker, takes jobs and returns results until there is a
//! reason to end.
mod case;
mod options;
mod proof;
mod state;

pub use options::{Ending, SessionOptions};

use crate::{
    pool::{Pool, SlotOptions},
    simulator::described,
};
use link::WorkerEnd;
use protocol::{announce::Announcement, job::kind, wire};
use state::{State, Step};
use std::{
    future::Future,
    io, thread,
    time::{Duration, Instant},
};
use tokio::sync::mpsc::unbounded_channel;

/// Interval of the session's periodic tasks.
const TICK: Duration = Duration::from_millis(250);

/// Time for which a leaving worker waits for the coordinator's acknowledgement.
const LEAVE_TIMEOUT: Duration = Duration::from_millis(500);

/// Serves until there is a reason to end; `asked` completes when the process is asked to end.
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
    let announcement = announcement(&options);
    let mut state = State::new(options, announcement, pool);
    let mut ticks = tokio::time::interval(TICK);
    ticks.set_missed_tick_behavior(tokio::time::MissedTickBehavior::Delay);
    let mut asked = std::pin::pin!(asked);
    let ending = loop {
        let step = tokio::select! {
            frame = link.receive() => match frame {
                Some(frame) => state.handle_frame(&mut link, &frame, begun.elapsed()).await,
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
        let heard = tokio::time::timeout(LEAVE_TIMEOUT, state.await_leave_ack(&mut link)).await;
        tracing::debug!(answered = heard.is_ok(), "left");
    }
    // ends the slots, which takes a moment and would hold up the link
    let ended = tokio::task::spawn_blocking(move || drop(state));
    link.close().await;
    ended.await.map_err(io::Error::other)?;
    Ok(ending)
}

fn announcement(options: &SessionOptions) -> Announcement {
    let profile = if cfg!(debug_assertions) {
        "debug"
    } else {
        "release"
    };
    Announcement {
        protocol: wire::VERSION,
        build: format!("{} {profile}", env!("CARGO_PKG_VERSION")),
        host: rustix::system::uname()
            .nodename()
            .to_string_lossy()
            .into_owned(),
        pid: std::process::id(),
        slots: u32::try_from(options.slots).unwrap_or(u32::MAX),
        cores: thread::available_parallelism()
            .map_or(0, |cores| u32::try_from(cores.get()).unwrap_or(u32::MAX)),
        job_kinds: kind::ALL.map(str::to_owned).to_vec(),
        models: described(options.simulators),
    }
}
