//! The door of a coordinator to the network: lets in whose certificate it knows, and nobody else.
//!
//! ```text
//! worker ---- QUIC, its certificate ----> gate ---- QUIC on loopback, a copy's name ----> router
//! ```
//!
//! The router has no QUIC door of its own to the network, because zenoh 1.10.2 shakes hands with
//! one peer at a time: a single datagram from anybody, certificate or not, keeps all workers out
//! for half a minute (measured: 31 s). The gate shakes hands with many at once, gives each three
//! seconds, makes peers prove their address once many wait, and says who was turned away and why.
//! Behind it, a worker's streams are passed on unread over a connection of their own, which shows
//! the router a certificate of the same name, made for this process and kept in memory. So the
//! router's access control still goes by certificate, and the gate knows nothing of the bus but
//! how many streams there are.
mod inner;
mod listed;
mod passing;
mod refusal;
pub(crate) mod terms;

pub(crate) use inner::Inner;

use crate::{
    LinkError,
    keys::{Keys, certificate_name, provider},
    locator::Locator,
};
use listed::Listed;
use passing::join;
use quinn::{
    Connection, ConnectionError, Endpoint, Incoming, TransportConfig, VarInt,
    crypto::rustls::{HandshakeData, QuicServerConfig},
};
use refusal::Refusals;
use rustls::{ServerConfig, pki_types::CertificateDer, server::WebPkiClientVerifier};
use std::{
    net::{SocketAddr, ToSocketAddrs},
    sync::Arc,
    time::Duration,
};
use terms::{BUS, CROWDED, HANDSHAKE, KNOCK, UNLISTED, WELCOME};
use tokio::{
    sync::{Semaphore, watch},
    task::JoinHandle,
    time::timeout,
};

/// Streams of the bus in one direction: one for each priority but the highest.
const STREAMS: u32 = 7;
/// Peers with which hands are shaken at a time.
const PENDING: usize = 1024;
/// Beyond so many, peers must show first that they are where they say.
const TRUSTING: usize = 64;
/// How long the last words may take at the end.
const FAREWELL: Duration = Duration::from_millis(200);

/// An open gate; nobody comes in any more once it is dropped.
#[derive(Debug)]
pub(crate) struct Gate {
    endpoint: Endpoint,
    task: JoinHandle<()>,
    /// Reads the list of names again.
    reading: JoinHandle<()>,
}

/// What is needed to let somebody in.
struct House {
    /// Who may come in by now.
    listed: watch::Receiver<Listed>,
    inner: Arc<Inner>,
    refusals: Refusals,
}

impl Gate {
    /// Opens a gate at an address, in front of a router that listens as `inner` says.
    pub(crate) fn open(at: &Locator, keys: &Keys, inner: Arc<Inner>) -> Result<Self, LinkError> {
        let failed = |reason: String| LinkError::Transport {
            doing: format!("listen on {at}"),
            reason,
        };
        let config = server_config(keys)?;
        let config = QuicServerConfig::try_from(config).map_err(|e| failed(e.to_string()))?;
        let mut config = quinn::ServerConfig::with_crypto(Arc::new(config));
        config.transport_config(Arc::new(streams()));
        let address = (at.bare_host(), at.port)
            .to_socket_addrs()
            .map_err(|error| failed(error.to_string()))?
            .next()
            .ok_or_else(|| failed("the host has no address".to_owned()))?;
        let endpoint =
            Endpoint::server(config, address).map_err(|error| failed(error.to_string()))?;
        let (say, listed) = watch::channel(Listed::new(keys.workers()));
        let reading = tokio::spawn(listed::read_again(keys.clone(), Arc::clone(&inner), say));
        let house = House {
            listed,
            inner,
            refusals: Refusals::default(),
        };
        let task = tokio::spawn(admit(endpoint.clone(), Arc::new(house)));
        Ok(Self {
            endpoint,
            task,
            reading,
        })
    }

    /// Closes the gate and the connections through it.
    pub(crate) async fn close(self) {
        self.shut();
        if timeout(FAREWELL, self.endpoint.wait_idle()).await.is_err() {
            tracing::debug!("peers did not take leave in time");
        }
    }

    fn shut(&self) {
        self.task.abort();
        self.reading.abort();
        self.endpoint.close(VarInt::from_u32(WELCOME), b"closed");
    }
}

impl Drop for Gate {
    fn drop(&mut self) {
        self.shut();
    }
}

fn server_config(keys: &Keys) -> Result<ServerConfig, LinkError> {
    let chain = keys.chain()?;
    let unfit = |error: &dyn std::fmt::Display| LinkError::Transport {
        doing: "use the coordinator's certificate".to_owned(),
        reason: error.to_string(),
    };
    let verifier = WebPkiClientVerifier::builder_with_provider(Arc::new(chain.roots), provider())
        .build()
        .map_err(|error| unfit(&error))?;
    let mut config = ServerConfig::builder_with_provider(provider())
        .with_protocol_versions(&[&rustls::version::TLS13])
        .and_then(|builder| {
            builder
                .with_client_cert_verifier(verifier)
                .with_single_cert(chain.certificates, chain.key)
        })
        .map_err(|error| unfit(&error))?;
    config.alpn_protocols = vec![BUS.to_vec(), KNOCK.to_vec()];
    Ok(config)
}

/// As many streams as the bus uses, so that a peer cannot open others.
fn streams() -> TransportConfig {
    let mut config = TransportConfig::default();
    config.max_concurrent_bidi_streams(VarInt::from_u32(1));
    config.max_concurrent_uni_streams(VarInt::from_u32(STREAMS));
    config.datagram_receive_buffer_size(None);
    config
}

/// Takes connections as they come.
async fn admit(endpoint: Endpoint, house: Arc<House>) {
    let pending = Arc::new(Semaphore::new(PENDING));
    while let Some(incoming) = endpoint.accept().await {
        let waiting = PENDING - pending.available_permits();
        if waiting >= TRUSTING && !incoming.remote_address_validated() && incoming.may_retry() {
            if let Err(error) = incoming.retry() {
                tracing::debug!(%error, "a peer was not asked for its address");
            }
            continue;
        }
        let Ok(permit) = Arc::clone(&pending).try_acquire_owned() else {
            incoming.refuse();
            continue;
        };
        let house = Arc::clone(&house);
        drop(tokio::spawn(async move {
            let from = incoming.remote_address();
            let shaken = timeout(HANDSHAKE, shake(incoming)).await;
            drop(permit);
            match shaken {
                Ok(Ok(connection)) => enter(&house, connection, from).await,
                Ok(Err(error)) => house.refusals.tell(from, &error.to_string()),
                Err(_) => tracing::debug!(%from, "a peer did not finish its handshake"),
            }
        }));
    }
}

async fn shake(incoming: Incoming) -> Result<Connection, ConnectionError> {
    incoming.accept()?.await
}

/// Lets a peer in whose certificate was accepted, if its name is on the list.
async fn enter(house: &House, connection: Connection, from: SocketAddr) {
    let owner = owner(&connection).unwrap_or_default();
    let Some(places) = listed::places(house.listed.clone(), &owner).await else {
        house.refusals.unlisted(from, &owner);
        connection.close(VarInt::from_u32(UNLISTED), b"not on the list of workers");
        return;
    };
    if asks_only(&connection) {
        connection.close(VarInt::from_u32(WELCOME), b"welcome");
        return;
    }
    let Ok(_place) = places.try_acquire() else {
        house.refusals.crowded(from, &owner);
        connection.close(VarInt::from_u32(CROWDED), b"too many connections");
        return;
    };
    match house.inner.connect(&owner, streams()).await {
        Ok(inner) => tokio::select! {
            () = join(&connection, &inner) => {}
            () = listed::struck(house.listed.clone(), &owner) => {
                tracing::warn!(%from, "\"{owner}\" was taken off the list of workers: it is out");
                connection.close(VarInt::from_u32(UNLISTED), b"taken off the list of workers");
            }
        },
        Err(error) => {
            tracing::warn!(%from, %error, "a worker cannot be connected to the bus");
            connection.close(VarInt::from_u32(WELCOME), b"try again");
        }
    }
}

/// Name of the certificate that the peer has shown.
fn owner(connection: &Connection) -> Option<String> {
    let shown = connection.peer_identity()?;
    let chain = shown.downcast::<Vec<CertificateDer<'static>>>().ok()?;
    certificate_name(chain.first()?)
}

fn asks_only(connection: &Connection) -> bool {
    let data = connection.handshake_data();
    let data = data.and_then(|data| data.downcast::<HandshakeData>().ok());
    data.is_some_and(|data| data.protocol.as_deref() == Some(KNOCK))
}
