//! Main program of a worker: a worker on the bus or one of its slots, depending on the command line.
use crate::{
    cli::{Cli, ProcessRole as CliRole},
    external,
    session::{self, Ending, SessionOptions},
    simulator::{Simulators, described},
    slot,
    status::{Status, StatusFile},
};
use anyhow::Context;
use clap::Parser;
use link::{
    LinkError,
    keys::{KeyRole, Keys},
    locator::{Locator, Protocol},
    zenoh::ZenohWorker,
};
use protocol::id::{WorkerId, draw};
use rustix::process::{Signal, set_parent_process_death_signal};
use std::{
    env,
    future::Future,
    io::{self, IsTerminal, Read},
    process::ExitCode,
    sync::Arc,
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};
use tokio::{
    signal::unix::{SignalKind, signal},
    sync::mpsc,
};
use tracing_subscriber::EnvFilter;

/// Interval between warnings about a coordinator that does not answer.
const COMPLAINT: Duration = Duration::from_mins(5);

/// Runs the worker program to its end; `simulators` are the kinds of model that it simulates.
pub fn run(simulators: Simulators) -> ExitCode {
    let cli = Cli::parse();
    // a worker of somebody's own says when it is connected; a local one leaves that to its coordinator
    let own = if cli.embedded || cli.role.is_some() {
        "warn"
    } else {
        "info"
    };
    let filter = EnvFilter::try_from_env("HORSEHEAD_LOG").unwrap_or_else(|_| {
        EnvFilter::new(format!(
            "warn,worker::program={own},worker::session={own},zenoh=off"
        ))
    });
    tracing_subscriber::fmt()
        .with_env_filter(filter)
        .with_writer(io::stderr)
        .with_ansi(io::stderr().is_terminal())
        .init();
    let ended = match cli.role {
        Some(CliRole::Slot { memory }) => slot::serve(simulators, memory)
            .map(|()| ExitCode::SUCCESS)
            .context("the slot ended"),
        Some(CliRole::Start(start)) => {
            // comes back only if it could not be started
            let why =
                external::start::start(&start).map_or_else(|e| e.to_string(), |()| String::new());
            let program = start
                .command
                .first()
                .map_or_else(Default::default, |it| it.to_string_lossy());
            tracing::error!("{program} cannot be started: {why}");
            return ExitCode::from(127);
        }
        None => serve(&cli, simulators),
    };
    ended.unwrap_or_else(|error| {
        tracing::error!("{error:#}");
        ExitCode::FAILURE
    })
}

fn serve(cli: &Cli, simulators: Simulators) -> anyhow::Result<ExitCode> {
    let locator = cli
        .connect
        .as_ref()
        .context("no coordinator address was given: set --connect or HORSEHEAD_CONNECT")?;
    if cli.embedded {
        set_parent_process_death_signal(Some(Signal::KILL))?;
    }
    // is ready when the coordinator answers; should there be no thread for it, it is computed then
    drop(
        thread::Builder::new()
            .name("digest".to_owned())
            .spawn(move || described(simulators)),
    );
    let status = Arc::new(StatusFile::new(cli.status.clone()));
    status.set(Status::Connecting(""));
    let cores = || thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let options = SessionOptions {
        simulators,
        id: draw_id(),
        slots: cli.slots.map_or_else(cores, usize::from),
        program: env::current_exe().context("the path of this program cannot be determined")?,
        slot_memory_mib: cli.slot_memory,
        idle_timeout: cli.idle_timeout.map(Duration::from_secs),
        embedded: cli.embedded,
        status: Arc::clone(&status),
    };
    let keys = match (&cli.tls, locator.protocol) {
        (Some(folder), Protocol::Quic) => match Keys::read(folder, KeyRole::Worker) {
            Ok(keys) => Some(keys),
            Err(error) => return Ok(refused(&status, &error)),
        },
        (None, _) | (_, Protocol::Unix | Protocol::Tcp) => None,
    };
    let runtime = tokio::runtime::Builder::new_multi_thread()
        .worker_threads(2)
        .enable_all()
        .build()
        .context("the runtime did not start")?;
    let ending = runtime.block_on(work(locator, keys, options));
    runtime.shutdown_timeout(Duration::from_millis(200));
    if let Err(error) = &ending {
        status.set(Status::Ended(&format!("{error:#}")));
    }
    Ok(match ending? {
        Ending::Refused(reason) => refused(&status, &reason),
        Ending::Unlinked => {
            status.set(Status::Ended("the connection to the coordinator is closed"));
            ExitCode::FAILURE
        }
        ending @ (Ending::Asked | Ending::RunOver | Ending::Idle) => {
            tracing::info!("ended normally: {ending:?}");
            status.set(Status::Ended("it was asked to end, or had no work"));
            ExitCode::SUCCESS
        }
    })
}

/// States why this worker cannot take part until its setup is changed, and returns exit status 3.
fn refused(status: &StatusFile, reason: &dyn std::fmt::Display) -> ExitCode {
    tracing::error!("refused: {reason}");
    status.set(Status::Ended(&format!("refused: {reason}")));
    ExitCode::from(3)
}

async fn work(
    locator: &Locator,
    keys: Option<Keys>,
    options: SessionOptions,
) -> anyhow::Result<Ending> {
    let mut asked = asked_to_end(options.embedded)?;
    let began = Instant::now();
    let (patience, status) = (options.idle_timeout, Arc::clone(&options.status));
    let mut said: Option<Instant> = None;
    let link = loop {
        // in a task of its own: opening may hold its thread for seconds, and a signal must not wait
        let (to, keys, process) = (locator.clone(), keys.clone(), options.id.0);
        let opening =
            tokio::spawn(async move { ZenohWorker::open(&to, keys.as_ref(), process).await });
        tokio::select! {
            opened = opening => match opened.context("the connection's task ended")? {
                Ok(link) => break link,
                Err(error) if error.is_retryable() => {
                    if said.is_none_or(|said| said.elapsed() > COMPLAINT) {
                        tracing::warn!("{error}; trying again until it answers");
                        status.set(Status::Connecting(&error.to_string()));
                        said = Some(Instant::now());
                    }
                    tokio::time::sleep(Duration::from_millis(500)).await;
                }
                Err(
                    error @ (LinkError::NoKeys { .. }
                    | LinkError::Keys(_)
                    | LinkError::Distrusted { .. }
                    | LinkError::Refused { .. }),
                ) => return Ok(Ending::Refused(error.to_string())),
                Err(error) => return Err(error.into()),
            },
            () = &mut asked => return Ok(Ending::Asked),
            () = idle_timeout(began, patience) => return Ok(Ending::Idle),
        }
    };
    status.set(Status::Connecting(
        "the coordinator answers, and has not admitted it yet",
    ));
    tracing::info!(
        "connected to {locator}; {} simulations at a time",
        options.slots
    );
    Ok(session::run(link, options, asked).await?)
}

/// Waits until the idle timeout, counted from `began`, has passed; waits forever if there is no timeout.
async fn idle_timeout(began: Instant, patience: Option<Duration>) {
    match patience {
        Some(patience) => tokio::time::sleep(patience.saturating_sub(began.elapsed())).await,
        None => std::future::pending().await,
    }
}

/// Returns a future that completes when the worker is asked to end: by SIGTERM, SIGINT or, if embedded, the
/// end of its standard input.
fn asked_to_end(embedded: bool) -> io::Result<impl Future<Output = ()> + Send + Unpin> {
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    let (parent_here, mut parent_gone) = mpsc::channel::<()>(1);
    if embedded {
        thread::Builder::new()
            .name("parent".to_owned())
            .spawn(move || {
                let _here = parent_here;
                let mut byte = [0];
                while matches!(io::stdin().read(&mut byte), Ok(1)) {}
            })?;
    } else {
        // held for ever: nobody's end is ours
        tokio::spawn(async move {
            let _here = parent_here;
            std::future::pending::<()>().await;
        });
    }
    Ok(Box::pin(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
            _ = parent_gone.recv() => {}
        }
    }))
}

fn draw_id() -> WorkerId {
    let host = rustix::system::uname()
        .nodename()
        .to_string_lossy()
        .into_owned();
    let nanos = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_nanos());
    WorkerId(draw(&format!("{host}:{}", std::process::id()), nanos))
}
