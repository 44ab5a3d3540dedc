//! The bus: the coordinator is the router, workers are its clients.
//!
//! Scouting and gossip are off, so an end talks to the one address it was given. Leases of 3 s
//! with six keep-alives show a dead peer in 2.8 s at most; every publication blocks rather than
//! drops, on a thread of its own; receivers are callbacks into a bounded channel, because the
//! default handler would hold up the receiving thread of all workers. `tls/` is not offered: it
//! corrupts memory in zenoh 1.10.2 (upstream issue 2557).
mod coordinator;
mod sender;
mod worker;

pub use coordinator::{CoordinatorOptions, ZenohCoordinator};
pub use worker::ZenohWorker;

use crate::{
    LinkError,
    locator::{Locator, Protocol},
};
use serde_json::{Value, json};
use std::{env, path::PathBuf, time::Duration};

/// Environment variable: path of the certificate authority (PEM).
pub const TLS_CA: &str = "HORSEHEAD_TLS_CA";
/// Environment variable: path of this end's certificate (PEM).
pub const TLS_CERTIFICATE: &str = "HORSEHEAD_TLS_CERTIFICATE";
/// Environment variable: path of this end's private key (PEM, PKCS#8).
pub const TLS_KEY: &str = "HORSEHEAD_TLS_KEY";

/// Frames that may wait to be read before further ones are dropped (and repeated by their
/// senders).
const INBOX: usize = 16 << 10;
/// Longest time that closing a session may take: with a dead peer zenoh needs 10 s.
const CLOSE: Duration = Duration::from_secs(2);

/// Where the key material of one end lies.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TlsFiles {
    /// Certificate of the authority that signed both ends.
    pub ca: PathBuf,
    /// Certificate of this end.
    pub certificate: PathBuf,
    /// Private key of this end.
    pub key: PathBuf,
}

impl TlsFiles {
    /// Reads the three variables; `None` unless all are set.
    pub fn from_env() -> Option<Self> {
        let path = |name| {
            env::var_os(name)
                .filter(|value| !value.is_empty())
                .map(PathBuf::from)
        };
        Some(Self {
            ca: path(TLS_CA)?,
            certificate: path(TLS_CERTIFICATE)?,
            key: path(TLS_KEY)?,
        })
    }

    fn listening(&self) -> Value {
        json!({
            "root_ca_certificate": self.ca, "listen_certificate": self.certificate,
            "listen_private_key": self.key, "enable_mtls": true, "close_link_on_expiration": true,
        })
    }

    fn connecting(&self) -> Value {
        json!({
            "root_ca_certificate": self.ca, "connect_certificate": self.certificate,
            "connect_private_key": self.key, "enable_mtls": true, "verify_name_on_connect": true,
        })
    }
}

/// What a session of either end is made of.
fn common(tls: &Value) -> Value {
    json!({
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "adminspace": { "enabled": false },
        "transport": {
            "unicast": { "max_sessions": 2000, "accept_pending": 1000 },
            "link": {
                "protocols": ["tcp", "quic"],
                "tx": { "lease": 3000, "keep_alive": 6 },
                "rx": { "max_message_size": 64 << 20 },
                "tls": tls,
            },
        },
    })
}

fn tls_for(
    locators: &[&Locator],
    tls: Option<&TlsFiles>,
    section: fn(&TlsFiles) -> Value,
) -> Result<Value, LinkError> {
    let Some(secured) = locators
        .iter()
        .find(|locator| locator.protocol == Protocol::Quic)
    else {
        return Ok(json!({}));
    };
    tls.map(section).ok_or_else(|| LinkError::NoCertificates {
        locator: secured.to_string(),
    })
}

async fn open(config: &Value, doing: &str) -> Result<zenoh::Session, LinkError> {
    let config =
        zenoh::Config::from_json5(&config.to_string()).map_err(|error| transport(doing, &error))?;
    zenoh::open(config)
        .await
        .map_err(|error| transport(doing, &error))
}

fn transport(doing: &str, reason: &dyn std::fmt::Display) -> LinkError {
    let reason = reason.to_string();
    // the transport adds where in its own source it noticed, which helps nobody here
    let words = reason.split(" at /").next().unwrap_or(&reason);
    LinkError::Transport {
        doing: doing.to_owned(),
        reason: words.trim_end_matches('.').to_owned(),
    }
}

async fn close(session: zenoh::Session) {
    if !matches!(
        tokio::time::timeout(CLOSE, async { session.close().await }).await,
        Ok(Ok(()))
    ) {
        tracing::debug!("the session did not close in time");
    }
}
