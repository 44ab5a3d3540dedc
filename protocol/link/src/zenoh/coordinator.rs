//! The coordinator's end: an embedded router with its listeners.
use super::{INBOX, TlsFiles, close, common, open, sender::Sender, tls_for, transport};
use crate::{Blob, CoordinatorEnd, Heard, LinkError, locator::Locator};
use protocol::{
    id::{RunId, WorkerId},
    key::{self, Lane},
};
use serde_json::json;
use tokio::sync::mpsc;
use zenoh::{Session, bytes::Encoding, sample::SampleKind};

/// Where and for what a coordinator listens.
#[derive(Clone, Debug)]
pub struct CoordinatorOptions {
    /// Addresses; a port of 0 is replaced by a free one.
    pub listen: Vec<Locator>,
    /// Whether unencrypted addresses may be open to the network.
    pub insecure: bool,
    /// Key material for QUIC.
    pub tls: Option<TlsFiles>,
    /// The run it works for.
    pub run: RunId,
    /// What workers may fetch.
    pub blob: Blob,
}

/// A coordinator on the bus.
#[derive(Debug)]
pub struct ZenohCoordinator {
    session: Session,
    sender: Sender,
    heard: mpsc::Receiver<Heard>,
    run: RunId,
    listening: Vec<Locator>,
}

impl ZenohCoordinator {
    /// Opens the router and starts to listen.
    ///
    /// # Errors
    /// [`LinkError::Exposed`] or [`LinkError::NoCertificates`] for addresses that may not be
    /// listened on as they are; [`LinkError::Transport`] if the address is taken.
    pub async fn open(options: CoordinatorOptions) -> Result<Self, LinkError> {
        let CoordinatorOptions {
            listen,
            insecure,
            tls,
            run,
            blob,
        } = options;
        let mut listening = Vec::new();
        for locator in listen {
            locator.permit(insecure)?;
            listening.push(locator.with_free_port()?);
        }
        let references: Vec<&Locator> = listening.iter().collect();
        let mut config = common(&tls_for(&references, tls.as_ref(), TlsFiles::listening)?);
        let names: Vec<String> = listening.iter().map(ToString::to_string).collect();
        config["mode"] = json!("router");
        config["listen"] = json!({ "endpoints": names, "exit_on_failure": true, "timeout_ms": 0 });
        config["connect"] = json!({ "endpoints": [] });
        let session = open(&config, &format!("listen on {}", names.join(", "))).await?;
        let (to, heard) = mpsc::channel(INBOX);
        for lane in [Lane::Data, Lane::Control] {
            subscribe(&session, lane, to.clone()).await?;
        }
        watch_presence(&session, run, to).await?;
        serve(&session, run, blob).await?;
        let sender = Sender::start(session.clone())
            .map_err(|error| transport("start the sending thread", &error))?;
        Ok(Self {
            session,
            sender,
            heard,
            run,
            listening,
        })
    }

    /// Where it listens, with the ports that were found.
    pub fn listening(&self) -> &[Locator] {
        &self.listening
    }
}

impl CoordinatorEnd for ZenohCoordinator {
    fn send(&mut self, to: WorkerId, lane: Lane, frame: Vec<u8>) {
        self.sender
            .send(key::to_worker(self.run, to, lane), lane, frame);
    }

    async fn receive(&mut self) -> Option<Heard> {
        self.heard.recv().await
    }

    async fn close(self) {
        self.sender.finish().await;
        close(self.session).await;
    }
}

fn offer(to: &mpsc::Sender<Heard>, heard: Heard) {
    if to.try_send(heard).is_err() {
        tracing::debug!("a frame was dropped: too many are waiting");
    }
}

async fn subscribe(
    session: &Session,
    lane: Lane,
    to: mpsc::Sender<Heard>,
) -> Result<(), LinkError> {
    session
        .declare_subscriber(key::all_from_workers(lane))
        .callback(move |sample| {
            if let Some(worker) = key::worker_of(sample.key_expr().as_str()) {
                offer(
                    &to,
                    Heard::Frame(worker, sample.payload().to_bytes().into_owned()),
                );
            }
        })
        .background()
        .await
        .map_err(|error| transport("subscribe to workers", &error))
}

async fn watch_presence(
    session: &Session,
    run: RunId,
    to: mpsc::Sender<Heard>,
) -> Result<(), LinkError> {
    session
        .liveliness()
        .declare_subscriber(key::all_alive(run))
        .callback(move |sample| {
            if sample.kind() == SampleKind::Delete
                && let Some(worker) = key::worker_of(sample.key_expr().as_str())
            {
                offer(&to, Heard::Gone(worker));
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
