//! Authenticating QUIC proxy ("gate") between the network and the coordinator's router: admits only peers
//! whose certificate is signed by the coordinator's authority and whose name is on the list of workers.
//!
//! ```text
//! worker ---- QUIC, its certificate ----> gate ---- QUIC on loopback, a copy's name ----> router
//! ```
//!
//! The router itself does not listen for QUIC on the network, because zenoh 1.10.2 performs one handshake at
//! a time: a single datagram from any sender, with or without a certificate, blocks all workers for half a
//! minute (measured: 31 s). The gate performs many handshakes concurrently, gives each three seconds,
//! requires address validation (QUIC retry) once many are pending, and logs each refusal with its reason.
//! Behind the gate, a worker's streams are forwarded without inspection over a connection of their own, which
//! presents to the router a certificate of the same name, made for this process and kept in memory. The
//! router's access control therefore still works by certificate name, and the gate needs to know only the
//! number of streams of the bus protocol.
mod allow_list;
mod forward;
mod inner;
mod refusal;
pub(crate) mod terms;

pub(crate) use inner::RouterConnector;

use crate::{
    LinkError,
    keys::{Keys, certificate_name, provider},
    locator::Locator,
};
use allow_list::AllowList;
use forward::forward_streams;
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
use terms::{ALPN_PROBE, ALPN_ZENOH, CLOSE_OK, CLOSE_TOO_MANY_CONNECTIONS, HANDSHAKE, UNLISTED};
use tokio::{
    sync::{Semaphore, watch},
    task::JoinHandle,
    time::timeout,
};

/// Number of unidirectional streams of the bus per direction: one for each priority except the highest.
const STREAMS: u32 = 7;
/// Maximum number of handshakes that the gate (authenticating proxy) performs concurrently.
const PENDING: usize = 1024;
/// Number of pending handshakes above which peers must validate their address (QUIC retry) first.
const RETRY_THRESHOLD: usize = 64;
/// Maximum time for the closing exchange with peers at shutdown.
const CLOSE_TIMEOUT: Duration = Duration::from_millis(200);

/// Running gate (authenticating proxy before the router); dropping it closes the gate and all connections
/// through it.
#[derive(Debug)]
pub(crate) struct Gate {
    endpoint: Endpoint,
    task: JoinHandle<()>,
    /// Task that reads the list of workers again periodically.
    reading: JoinHandle<()>,
}

/// State of a gate (authenticating proxy) shared by all its connections.
struct AdmissionContext {
    /// Latest version of the list of workers that may join.
    listed: watch::Receiver<AllowList>,
    inner: Arc<RouterConnector>,
    refusals: Refusals,
}

impl Gate {
    /// Opens a gate (authenticating proxy) at an address; admitted connections are forwarded to the router
    /// described by `inner`.
    pub(crate) fn open(
        at: &Locator,
        keys: &Keys,
        inner: Arc<RouterConnector>,
    ) -> Result<Self, LinkError> {
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
        let (say, listed) = watch::channel(AllowList::new(keys.workers()));
        let reading = tokio::spawn(allow_list::read_again(
            keys.clone(),
            Arc::clone(&inner),
            say,
        ));
        let context = AdmissionContext {
            listed,
            inner,
            refusals: Refusals::default(),
        };
        let task = tokio::spawn(admit(endpoint.clone(), Arc::new(context)));
        Ok(Self {
            endpoint,
            task,
            reading,
        })
    }

    /// Closes the gate and all connections through it; waits briefly for peers to be notified.
    pub(crate) async fn close(self) {
        self.shut();
        if timeout(CLOSE_TIMEOUT, self.endpoint.wait_idle())
            .await
            .is_err()
        {
            tracing::debug!("peers did not take leave in time");
        }
    }

    fn shut(&self) {
        self.task.abort();
        self.reading.abort();
        self.endpoint.close(VarInt::from_u32(CLOSE_OK), b"closed");
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
    config.alpn_protocols = vec![ALPN_ZENOH.to_vec(), ALPN_PROBE.to_vec()];
    Ok(config)
}

/// Returns a transport configuration that allows exactly the number of streams that the bus uses, so that
/// peers cannot open others.
fn streams() -> TransportConfig {
    let mut config = TransportConfig::default();
    config.max_concurrent_bidi_streams(VarInt::from_u32(1));
    config.max_concurrent_uni_streams(VarInt::from_u32(STREAMS));
    config.datagram_receive_buffer_size(None);
    config
}

/// Accepts incoming connections and handles each in a task of its own.
async fn admit(endpoint: Endpoint, context: Arc<AdmissionContext>) {
    let pending = Arc::new(Semaphore::new(PENDING));
    while let Some(incoming) = endpoint.accept().await {
        let waiting = PENDING - pending.available_permits();
        if waiting >= RETRY_THRESHOLD
            && !incoming.remote_address_validated()
            && incoming.may_retry()
        {
            if let Err(error) = incoming.retry() {
                tracing::debug!(%error, "a peer was not asked for its address");
            }
            continue;
        }
        let Ok(permit) = Arc::clone(&pending).try_acquire_owned() else {
            incoming.refuse();
            continue;
        };
        let context = Arc::clone(&context);
        drop(tokio::spawn(async move {
            let from = incoming.remote_address();
            let shaken = timeout(HANDSHAKE, shake(incoming)).await;
            drop(permit);
            match shaken {
                Ok(Ok(connection)) => enter(&context, connection, from).await,
                Ok(Err(error)) => context.refusals.warn(from, &error.to_string()),
                Err(_) => tracing::debug!(%from, "a peer did not finish its handshake"),
            }
        }));
    }
}

async fn shake(incoming: Incoming) -> Result<Connection, ConnectionError> {
    incoming.accept()?.await
}

/// Admits a peer whose certificate is valid, whose name is on the list of workers and has a free connection;
/// then forwards its streams until the connection ends.
async fn enter(context: &AdmissionContext, connection: Connection, from: SocketAddr) {
    let owner = owner(&connection).unwrap_or_default();
    let Some(places) = allow_list::places(context.listed.clone(), &owner).await else {
        context.refusals.unlisted(from, &owner);
        connection.close(VarInt::from_u32(UNLISTED), b"not on the list of workers");
        return;
    };
    if asks_only(&connection) {
        connection.close(VarInt::from_u32(CLOSE_OK), b"welcome");
        return;
    }
    let Ok(_place) = places.try_acquire() else {
        context.refusals.crowded(from, &owner);
        connection.close(
            VarInt::from_u32(CLOSE_TOO_MANY_CONNECTIONS),
            b"too many connections",
        );
        return;
    };
    match context.inner.connect(&owner, streams()).await {
        Ok(inner) => tokio::select! {
            () = forward_streams(&connection, &inner) => {}
            () = allow_list::removed(context.listed.clone(), &owner) => {
                tracing::warn!(%from, "\"{owner}\" was taken off the list of workers: it is out");
                connection.close(VarInt::from_u32(UNLISTED), b"taken off the list of workers");
            }
        },
        Err(error) => {
            tracing::warn!(%from, %error, "a worker cannot be connected to the bus");
            connection.close(VarInt::from_u32(CLOSE_OK), b"try again");
        }
    }
}

/// Returns the common name of the peer's certificate.
fn owner(connection: &Connection) -> Option<String> {
    let shown = connection.peer_identity()?;
    let chain = shown.downcast::<Vec<CertificateDer<'static>>>().ok()?;
    certificate_name(chain.first()?)
}

fn asks_only(connection: &Connection) -> bool {
    let data = connection.handshake_data();
    let data = data.and_then(|data| data.downcast::<HandshakeData>().ok());
    data.is_some_and(|data| data.protocol.as_deref() == Some(ALPN_PROBE))
}
