//! The asynchronous glue between link, core and journal, and the only way to have work done.
//!
//! [`Dispatch`] is opened on a run folder, given jobs and asked for results. What it does in
//! between runs on a task of its own, so that a caller that computes for a while holds up nobody.
mod bench;
mod engine;
mod error;
mod local;
pub mod locate;
mod sleep;

pub use crate::core::{Policy, Snapshot, WorkerSnapshot};
pub use bench::{
    BenchPlan, BenchResult, Crew, Silence, SilentPlan, SilentResult, bench, connect, keep_silent,
};
pub use error::DispatchError;
pub use protocol::event::{RunHeader, Spent};

use crate::{
    core::{Core, CoreOptions},
    journal::Journal,
};
use engine::{Engine, Request};
use link::{
    Blob, CoordinatorEnd, LinkError,
    keys::{Keys, Role},
    locator::{Locator, Protocol},
    zenoh::{CoordinatorOptions, ZenohCoordinator},
};
use local::LocalWorkers;
use protocol::{
    case::Case,
    id::{JobId, RunId, draw},
    job::{Job, Outcome},
    wire,
};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::{
    collections::BTreeSet,
    net::{TcpListener, UdpSocket},
    path::PathBuf,
    sync::{Arc, Mutex, PoisonError},
    time::{SystemTime, UNIX_EPOCH},
};
use tokio::{
    sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel},
    task::JoinHandle,
};

/// Open files beyond which nothing is gained: the link takes no more connections.
const FILES: u64 = 16 << 10;

/// What a run is opened with.
#[derive(Clone, Debug)]
pub struct DispatchOptions {
    /// Folder of the run's journal; made if it is not there.
    pub run_dir: PathBuf,
    /// Address for workers of other machines; `None` for local workers only.
    pub listen: Option<String>,
    /// Whether that address may be unencrypted and open to the network.
    pub insecure: bool,
    /// Folder of the coordinator's key material, for QUIC addresses.
    pub tls: Option<PathBuf>,
    /// Worker processes to start on this machine, with one slot each.
    pub local_workers: usize,
    /// What the jobs are about.
    pub case: Case,
    /// What decides the result of the run.
    pub header: RunHeader,
}

/// A job with its result.
#[derive(Clone, Debug, PartialEq)]
pub struct Completed {
    /// The job.
    pub id: JobId,
    /// Its one accepted outcome.
    pub outcome: Outcome,
    /// Whether it comes from the journal of an earlier process.
    pub replayed: bool,
}

/// How a run went, from the opening to the closing of this process.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// The last state, with the account of slot time.
    pub last: Snapshot,
    /// Results taken from the journal instead of being computed.
    pub replayed: u64,
    /// Time between opening and closing \[s\].
    pub wall_s: f64,
}

/// A run that is open.
#[derive(Debug)]
pub struct Dispatch {
    requests: UnboundedSender<Request>,
    completed: UnboundedReceiver<Result<Completed, DispatchError>>,
    snapshot: Arc<Mutex<Snapshot>>,
    engine: JoinHandle<Summary>,
    listening: Vec<Locator>,
    recorded: usize,
}

impl Dispatch {
    /// Opens the journal (or goes on with it), the bus and the local workers.
    ///
    /// # Errors
    /// [`DispatchError::Journal`] if the run cannot be written or was begun with something else,
    /// [`DispatchError::Link`] if the address cannot be listened on, [`DispatchError::Locate`] if
    /// there is no worker program, [`DispatchError::NobodyToAsk`] without any workers.
    pub async fn open(options: DispatchOptions) -> Result<Self, DispatchError> {
        let (listen, local) = addresses(&options)?;
        allow_connections();
        // a folder that was made for a run that cannot begin would only be in the way
        for locator in &listen {
            admissible(locator, options.insecure)?;
        }
        let keys = keys(&options, &listen)?;
        let program = match local {
            Some(_) => Some(locate::worker_program()?),
            None => None,
        };
        let parts = Parts::open(&options)?;
        let (run, blob) = (parts.run, parts.blob.clone());
        let insecure = options.insecure;
        let link_options = CoordinatorOptions {
            listen,
            insecure,
            keys,
            run,
            blob,
        };
        let link = ZenohCoordinator::open(link_options).await?;
        let listening = link.listening().to_vec();
        let workers = match (local.and_then(|at| listening.get(at)), program) {
            (Some(locator), Some(program)) => {
                let count = options.local_workers;
                Some(LocalWorkers::start(program, &locator.from_here(), count)?)
            }
            _ => None,
        };
        let only_local = options.listen.is_none();
        Ok(Self::begin(parts, link, workers, only_local, listening))
    }

    /// Opens a run over any link, without workers of its own; `make` is given the run's name and
    /// what workers may fetch. `options.listen`, `insecure` and `local_workers` are not used.
    ///
    /// # Errors
    /// [`DispatchError::Journal`] as [`Self::open`].
    pub fn over<L: CoordinatorEnd>(
        options: &DispatchOptions,
        make: impl FnOnce(RunId, Blob) -> L,
    ) -> Result<Self, DispatchError> {
        let parts = Parts::open(options)?;
        let link = make(parts.run, parts.blob.clone());
        Ok(Self::begin(parts, link, None, false, Vec::new()))
    }

    fn begin<L: CoordinatorEnd>(
        parts: Parts,
        link: L,
        workers: Option<LocalWorkers>,
        only_local: bool,
        listening: Vec<Locator>,
    ) -> Self {
        let recorded = parts.journal.len();
        let (requests, asked) = unbounded_channel();
        let (deliver, completed) = unbounded_channel();
        let snapshot = Arc::new(Mutex::new(Snapshot::default()));
        let shown = Arc::clone(&snapshot);
        let engine = Engine::new(parts, link, workers, only_local, deliver, shown);
        let engine = tokio::spawn(engine.run(asked));
        Self {
            requests,
            completed,
            snapshot,
            engine,
            listening,
            recorded,
        }
    }

    /// How many results the journal held when the run was opened.
    pub const fn recorded(&self) -> usize {
        self.recorded
    }

    /// Where workers can connect, the first one as asked for.
    pub fn listening(&self) -> Vec<String> {
        self.listening.iter().map(ToString::to_string).collect()
    }

    /// Asks for a job to be done, once per process; a result that the journal holds already is
    /// delivered again at once.
    ///
    /// # Errors
    /// [`DispatchError::Closed`] once the run has been stopped.
    pub fn submit(&mut self, id: JobId, job: Job) -> Result<(), DispatchError> {
        let asked = Request::Submit {
            id,
            job: Box::new(job),
        };
        self.requests.send(asked).map_err(|_| DispatchError::Closed)
    }

    /// Waits for the next result, in the order of arrival; loses nothing when dropped.
    ///
    /// # Errors
    /// The reason why the run cannot go on: nothing but [`Self::close`] is of use afterwards.
    pub async fn next(&mut self) -> Result<Completed, DispatchError> {
        self.completed
            .recv()
            .await
            .unwrap_or(Err(DispatchError::Closed))
    }

    /// The state of the run, some hundredths of a second old at most.
    pub fn snapshot(&self) -> Snapshot {
        self.snapshot
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .clone()
    }

    /// Ends the run: workers are told, local ones ended, the journal closed; within 3 s, unless the
    /// disk is full: it waits for room, since workers forget their results at the end of a run. The
    /// same run can be opened again later.
    ///
    /// # Errors
    /// [`DispatchError::Closed`] if the runtime broke down before.
    pub async fn close(self) -> Result<Summary, DispatchError> {
        // an engine that has stopped needs no request
        drop(self.requests);
        self.engine.await.map_err(|_| DispatchError::Closed)
    }
}

/// What any run consists of, whatever its link.
struct Parts {
    run: RunId,
    core: Core,
    journal: Journal,
    said: UnboundedReceiver<crate::journal::Appended>,
    blob: Blob,
}

impl Parts {
    fn open(options: &DispatchOptions) -> Result<Self, DispatchError> {
        let now = SystemTime::now()
            .duration_since(UNIX_EPOCH)
            .unwrap_or_default();
        let place = format!("{}:{}", options.run_dir.display(), std::process::id());
        let fresh = RunId(draw(&place, now.as_nanos()));
        let (say, said) = unbounded_channel();
        let at_unix_ms = u64::try_from(now.as_millis()).unwrap_or(u64::MAX);
        let folder = &options.run_dir;
        let (journal, begun) = Journal::open(
            folder,
            &options.header,
            fresh,
            at_unix_ms,
            move |appended| {
                // at the very end nobody listens any more
                drop(say.send(appended));
            },
        )?;
        for damage in crate::journal::words(&begun.report.damage) {
            tracing::warn!("{damage}");
        }
        let blob = Blob::new(wire::encode(&options.case)?);
        let core = Core::new(CoreOptions {
            run: begun.run,
            epoch: begun.epoch,
            case: blob.hash,
            case_bytes: blob.bytes.len() as u64,
            model_digest: begun.model_digest,
            proof: begun.proof,
            finished: journal.finished().collect(),
            // local workers end with their coordinator
            expected: if options.listen.is_some() {
                begun.present
            } else {
                BTreeSet::new()
            },
            policy: Policy::default(),
        });
        Ok(Self {
            run: begun.run,
            core,
            journal,
            said,
            blob,
        })
    }
}

/// Has the system allow as many open connections as it may: a shell gives a process a thousand, which
/// a few silent peers would use up.
fn allow_connections() {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let wanted = maximum.map_or(FILES, |maximum| maximum.min(FILES));
    if current.is_none_or(|current| current >= wanted) {
        return;
    }
    let limit = Rlimit {
        current: Some(wanted),
        maximum,
    };
    if let Err(error) = setrlimit(Resource::Nofile, limit) {
        tracing::debug!(%error, "no more files may be open than before");
    }
}

/// Whether one may and can listen there, before anything is made or started for it.
fn admissible(locator: &Locator, insecure: bool) -> Result<(), DispatchError> {
    locator.permit(insecure)?;
    let at = (locator.bare_host(), locator.port);
    let tried = match locator.protocol {
        Protocol::Tcp => TcpListener::bind(at).map(drop),
        Protocol::Quic => UdpSocket::bind(at).map(drop),
    };
    tried.map_err(|source| DispatchError::Listen {
        locator: locator.to_string(),
        source,
    })
}

/// The key material, read and checked if an address needs it.
fn keys(options: &DispatchOptions, listen: &[Locator]) -> Result<Option<Keys>, DispatchError> {
    let Some(secured) = listen.iter().find(|at| at.protocol == Protocol::Quic) else {
        return Ok(None);
    };
    let folder = options.tls.as_ref().ok_or_else(|| LinkError::NoKeys {
        locator: secured.to_string(),
    })?;
    let keys = Keys::read(folder, Role::Coordinator).map_err(LinkError::from)?;
    Ok(Some(keys))
}

/// Where to listen, and which of it local workers use.
fn addresses(options: &DispatchOptions) -> Result<(Vec<Locator>, Option<usize>), DispatchError> {
    let loopback = || Locator::parse("tcp/127.0.0.1:0");
    let listen = options.listen.as_deref().map(Locator::parse).transpose()?;
    match (listen, options.local_workers) {
        (None, 0) => Err(DispatchError::NobodyToAsk),
        (None, _) => Ok((vec![loopback()?], Some(0))),
        (Some(asked), 0) => Ok((vec![asked], None)),
        (Some(asked), _) if asked.protocol == Protocol::Tcp => Ok((vec![asked], Some(0))),
        // local workers need no certificates
        (Some(asked), _) => Ok((vec![asked, loopback()?], Some(1))),
    }
}
