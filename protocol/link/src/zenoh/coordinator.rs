//! Coordinator's end of the bus: an embedded router with its listeners.
use super::session::{INBOX, close, common, needed, open, transport};
use super::{access, names::Names, sender::Sender};
use crate::{
    Blob, CoordinatorEnd, LinkError, LinkEvent,
    gate::{Gate, RouterConnector},
    keys::{Keys, pool},
    locator::{Locator, Protocol},
};
use protocol::{
    id::{RunId, WorkerId},
    key::{self, Lane},
};
use serde_json::{Value, json};
use std::{
    net::Ipv4Addr,
    sync::{Arc, Mutex, PoisonError},
    time::Instant,
};
use tokio::sync::mpsc;
use zenoh::{Session, bytes::Encoding, sample::SampleKind};

/// Settings for opening a coordinator's end of the link.
#[derive(Clone, Debug)]
pub struct CoordinatorOptions {
    /// Addresses to listen on; a port of 0 is replaced by a free one.
    pub listen: Vec<Locator>,
    /// Whether the coordinator may listen on TCP addresses, which have neither encryption nor authentication.
    pub insecure: bool,
    /// Key material for QUIC, including the names of the workers that may join.
    pub keys: Option<Keys>,
    /// Id of the run that the coordinator serves.
    pub run: RunId,
    /// Content (the encoded case) that workers may fetch.
    pub blob: Blob,
}

/// Maximum number of attempts to open with freshly chosen ports, because another program may take a port
/// between its choice and the listening on it.
const CHOICES: u32 = 5;

/// Coordinator's end of a link over Zenoh.
#[derive(Debug)]
pub struct ZenohCoordinator {
    session: Session,
    sender: Sender,
    heard: mpsc::Receiver<LinkEvent>,
    listening: Vec<Locator>,
    names: Arc<Mutex<Names>>,
    gates: Vec<Gate>,
}

impl ZenohCoordinator {
    /// Opens the coordinator's embedded router and starts to listen.
    ///
    /// # Errors
    /// [`LinkError::Exposed`], [`LinkError::Socket`] or [`LinkError::NoKeys`] for addresses that may not be listened on as given;
    /// [`LinkError::Transport`] if the address is taken.
    pub async fn open(options: CoordinatorOptions) -> Result<Self, LinkError> {
        // behind a gate, the router itself is at a port of our choice
        let chosen = |at: &Locator| match at.protocol {
            Protocol::Unix => false,
            Protocol::Tcp => at.port == 0,
            Protocol::Quic => true,
        };
        let mut left = if options.listen.iter().any(chosen) {
            CHOICES
        } else {
            1
        };
        loop {
            left -= 1;
            match Self::listen(options.clone()).await {
                Err(LinkError::Transport { doing, reason }) if left > 0 => {
                    tracing::debug!(doing, reason, "other ports are tried");
                }
                ended => return ended,
            }
        }
    }

    async fn listen(options: CoordinatorOptions) -> Result<Self, LinkError> {
        let CoordinatorOptions {
            listen,
            insecure,
            keys,
            run,
            blob,
        } = options;
        let mut locators = Vec::new();
        for locator in listen {
            locator.permit(insecure)?;
            locators.push(locator.with_free_port()?);
        }
        let references: Vec<&Locator> = locators.iter().collect();
        let keys = needed(&references, keys.as_ref())?;
        let (mut config, gates) = match keys {
            Some(keys) => behind_gates(&locators, keys)?,
            None => (common(&references, &json!({})), Vec::new()),
        };
        let at: Vec<String> = locators.iter().map(ToString::to_string).collect();
        let endpoints: Vec<String> = locators.iter().map(Locator::endpoint).collect();
        config["mode"] = json!("router");
        config["connect"] = json!({ "endpoints": [] });
        if gates.is_empty() {
            config["listen"]["endpoints"] = json!(endpoints);
        }
        config["listen"]["exit_on_failure"] = json!(true);
        config["listen"]["timeout_ms"] = json!(0);
        let session = open(&config, &format!("listen on {}", at.join(", "))).await?;
        let names = Arc::new(Mutex::new(Names::default()));
        let (to, heard) = mpsc::channel(INBOX);
        for lane in [Lane::Data, Lane::Control] {
            subscribe(&session, lane, to.clone(), Arc::clone(&names)).await?;
        }
        watch_presence(&session, run, to, Arc::clone(&names)).await?;
        serve(&session, run, blob).await?;
        let sender = Sender::new(session.clone());
        Ok(Self {
            session,
            sender,
            heard,
            listening: locators,
            names,
            gates,
        })
    }

    /// Returns the addresses on which the coordinator listens, with the ports that were chosen.
    pub fn listening(&self) -> &[Locator] {
        &self.listening
    }
}

impl CoordinatorEnd for ZenohCoordinator {
    fn send(&mut self, to: WorkerId, lane: Lane, frame: Vec<u8>) {
        let names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(name) = names.of(to) {
            let frame = (key::to_worker(name, lane), lane, frame);
            let present = |worker| names.of(WorkerId(worker)).is_some();
            self.sender.send(to.0, frame, present);
        } else {
            tracing::debug!(%to, "a frame was not sent: the worker is gone");
        }
    }

    fn owner(&self, worker: WorkerId) -> Option<String> {
        let names = self.names.lock().unwrap_or_else(PoisonError::into_inner);
        names.of(worker).map(|name| name.owner().to_owned())
    }

    async fn receive(&mut self) -> Option<LinkEvent> {
        self.heard.recv().await
    }

    async fn close(self) {
        self.sender.finish().await;
        close(self.session).await;
        for gate in self.gates {
            gate.close().await;
        }
    }
}

/// Creates the router's configuration for use behind authenticating proxies ("gates"), and one gate for each
/// QUIC address.
///
/// The router itself listens for QUIC only on a free loopback port, where it accepts only connections made by
/// a gate.
fn behind_gates(locators: &[Locator], keys: &Keys) -> Result<(Value, Vec<Gate>), LinkError> {
    let inside = Locator {
        protocol: Protocol::Quic,
        host: Ipv4Addr::LOCALHOST.to_string(),
        port: 0,
    }
    .with_free_port()?;
    let router = (Ipv4Addr::LOCALHOST, inside.port).into();
    let mut owners = keys.workers().clone();
    owners.extend(pool());
    let inner = Arc::new(RouterConnector::make(router, &owners)?);
    let (mut endpoints, mut gates) = (vec![inside.to_string()], Vec::new());
    for at in locators {
        if at.protocol != Protocol::Quic {
            endpoints.push(at.endpoint());
            continue;
        }
        gates.push(Gate::open(at, keys, Arc::clone(&inner))?);
    }
    let references: Vec<&Locator> = locators.iter().collect();
    let mut config = common(&references, inner.listening());
    config["access_control"] = access::control(&owners, endpoints.len() > 1);
    config["listen"]["endpoints"] = json!(endpoints);
    Ok((config, gates))
}

fn try_deliver(to: &mpsc::Sender<LinkEvent>, heard: LinkEvent) {
    if to.try_send(heard).is_err() {
        tracing::debug!("a frame was dropped: too many are waiting");
    }
}

async fn subscribe(
    session: &Session,
    lane: Lane,
    to: mpsc::Sender<LinkEvent>,
    names: Arc<Mutex<Names>>,
) -> Result<(), LinkError> {
    session
        .declare_subscriber(key::all_from_workers(lane))
        .callback(move |sample| {
            if let Some(worker) = key::worker_of(sample.key_expr().as_str()) {
                let worker = names
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .note(worker, Instant::now());
                if let Some(worker) = worker {
                    let frame = sample.payload().to_bytes().into_owned();
                    try_deliver(&to, LinkEvent::Frame(worker, frame));
                }
            }
        })
        .background()
        .await
        .map_err(|error| transport("subscribe to workers", &error))
}

async fn watch_presence(
    session: &Session,
    run: RunId,
    to: mpsc::Sender<LinkEvent>,
    names: Arc<Mutex<Names>>,
) -> Result<(), LinkError> {
    session
        .liveliness()
        .declare_subscriber(key::all_alive(run))
        .callback(move |sample| {
            if sample.kind() == SampleKind::Delete
                && let Some(worker) = key::worker_of(sample.key_expr().as_str())
            {
                let worker = worker.id();
                names
                    .lock()
                    .unwrap_or_else(PoisonError::into_inner)
                    .forget(worker);
                try_deliver(&to, LinkEvent::Disconnected(worker));
            }
        })
        .background()
        .await
        .map_err(|error| transport("watch the presence of workers", &error))
}

async fn serve(session: &Session, run: RunId, blob: Blob) -> Result<(), LinkError> {
    let runtime = tokio::runtime::Handle::current();
    session
        .declare_queryable(key::all_blobs(run))
        .callback(move |query| {
            let name = query.key_expr().as_str().to_owned();
            let piece = key::blob_of(&name).and_then(|(hash, chunk)| blob.chunk(hash, chunk));
            let piece = piece.map(<[u8]>::to_vec);
            // replying may wait for the pipe, and this is the receiving thread
            drop(runtime.spawn(async move {
                let replied = match piece {
                    Some(piece) => {
                        query
                            .reply(name, piece)
                            .encoding(Encoding::ZENOH_BYTES)
                            .await
                    }
                    None => query.reply_err("no such piece").await,
                };
                if let Err(error) = replied {
                    tracing::debug!(%error, "a piece was not sent");
                }
            }));
        })
        .background()
        .await
        .map_err(|error| transport("serve the case", &error))
}
