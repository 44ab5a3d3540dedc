//! Worker's end of the bus: a client with one address.
use super::sender::Sender;
use super::session::{INBOX, close, common, connecting, needed, open, transport};
use crate::{LinkError, WorkerEnd, handshake, keys::Keys, locator::Locator};
use protocol::{
    id::{ContentHash, RunId},
    key::{self, Lane},
    name::WorkerName,
};
use serde_json::json;
use std::{future::Future, time::Duration};
use tokio::sync::mpsc;
use zenoh::{
    Session,
    liveliness::LivelinessToken,
    qos::{CongestionControl, Priority},
    query::ConsolidationMode,
};

/// Maximum time for fetching one chunk of a blob.
const PIECE: Duration = Duration::from_secs(10);

/// Worker's end of a link over Zenoh.
#[derive(Debug)]
pub struct ZenohWorker {
    name: WorkerName,
    session: Session,
    sender: Sender,
    frames: mpsc::Receiver<Vec<u8>>,
    token: Option<LivelinessToken>,
}

impl ZenohWorker {
    /// Connects to a coordinator; the session repairs later interruptions itself. `process` distinguishes
    /// this worker from others with the same certificate, or without one.
    ///
    /// # Errors
    /// Faults of the key material or the address, or the reason why one end rejects the other's certificate;
    /// [`LinkError::is_retryable`] tells whether a retry may succeed.
    pub async fn open(
        connect: &Locator,
        keys: Option<&Keys>,
        process: u64,
    ) -> Result<Self, LinkError> {
        let keys = needed(&[connect], keys)?;
        let name = if let Some(keys) = keys {
            handshake::probe_quic(connect, keys).await?;
            // checked when the keys were read
            WorkerName::of(keys.owner(), process).map_err(|source| {
                LinkError::Keys(crate::keys::KeyError::Name {
                    path: keys.certificate(),
                    source,
                })
            })?
        } else {
            handshake::probe_plain(connect).await?;
            WorkerName::anyone(process)
        };
        let tls = keys.map_or_else(|| json!({}), connecting);
        let mut config = common(&[connect], &tls);
        config["mode"] = json!("client");
        config["listen"] = json!({ "endpoints": [] });
        config["connect"] = json!({
            "endpoints": [connect.endpoint()], "timeout_ms": 10_000, "exit_on_failure": false,
            "retry": { "period_init_ms": 500, "period_max_ms": 2000, "period_increase_factor": 1.5 },
        });
        let session = open(&config, &format!("connect to {connect}")).await?;
        let (to, frames) = mpsc::channel(INBOX);
        for lane in [Lane::Data, Lane::Control] {
            let to = to.clone();
            session
                .declare_subscriber(key::to_worker(&name, lane))
                .callback(move |sample| {
                    let frame = sample.payload().to_bytes().into_owned();
                    if to.try_send(frame).is_err() {
                        tracing::debug!("a frame was dropped: too many are waiting");
                    }
                })
                .background()
                .await
                .map_err(|error| transport("subscribe to jobs", &error))?;
        }
        let sender = Sender::new(session.clone());
        Ok(Self {
            name,
            session,
            sender,
            frames,
            token: None,
        })
    }
}

impl WorkerEnd for ZenohWorker {
    fn send(&mut self, run: RunId, lane: Lane, frame: Vec<u8>) {
        let frame = (key::from_worker(run, &self.name, lane), lane, frame);
        self.sender.send(run.0, frame, |peer| peer == run.0);
    }

    async fn receive(&mut self) -> Option<Vec<u8>> {
        self.frames.recv().await
    }

    async fn announce_presence(&mut self, run: RunId) -> Result<(), LinkError> {
        self.token = None;
        let token = self
            .session
            .liveliness()
            .declare_token(key::alive(run, &self.name))
            .await
            .map_err(|error| transport("show presence", &error))?;
        self.token = Some(token);
        Ok(())
    }

    fn fetch(
        &self,
        run: RunId,
        hash: ContentHash,
        chunk: u32,
    ) -> impl Future<Output = Result<Vec<u8>, LinkError>> + Send + 'static {
        let session = self.session.clone();
        async move {
            let missing = |reason: String| LinkError::Piece {
                hash,
                chunk,
                reason,
            };
            let replies = session
                .get(key::blob(run, hash, chunk))
                .consolidation(ConsolidationMode::None)
                .congestion_control(CongestionControl::Block)
                .priority(Priority::DataLow)
                .timeout(PIECE)
                .await
                .map_err(|error| missing(error.to_string()))?;
            let reply = replies.recv_async().await;
            match reply
                .map_err(|_| missing("nobody answered".to_owned()))?
                .into_result()
            {
                Ok(sample) => Ok(sample.payload().to_bytes().into_owned()),
                Err(refused) => {
                    let reason = refused
                        .payload()
                        .try_to_string()
                        .unwrap_or_default()
                        .into_owned();
                    Err(missing(reason))
                }
            }
        }
    }

    async fn close(self) {
        self.sender.finish().await;
        drop(self.token);
        close(self.session).await;
    }
}
