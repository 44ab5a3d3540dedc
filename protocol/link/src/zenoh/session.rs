//! Zenoh session of either end: common configuration, opening and closing.
use crate::{
    LinkError,
    keys::Keys,
    locator::{Locator, Protocol},
};
use serde_json::{Value, json};
use std::{collections::BTreeSet, time::Duration};

/// Maximum number of received frames waiting to be read; further frames are dropped (and repeated by their
/// senders).
pub(super) const INBOX: usize = 16 << 10;
/// Maximum time for closing a session; with a dead peer zenoh needs 10 s.
const CLOSE: Duration = Duration::from_secs(2);

/// Maximum time for a connected peer to open its session \[ms\]; until then a silent peer counts towards
/// [`PENDING`].
const ACCEPT_MS: u64 = 4000;

/// Maximum number of sessions of an end. An idle session costs the coordinator its keep-alives, about 80 us
/// per second: this number leaves the coordinator about nine tenths of its throughput, twice the number about
/// seven tenths (`tests/README.md`).
const SESSIONS: usize = 1000;

/// Number of batches of 64 kB that a link queues for a peer that does not read, before it holds up the sender of its
/// frames: the buffer of a Unix socket takes only some 200 kB. The largest number that Zenoh allows.
const QUEUED: usize = 16;

/// Maximum number of connections waiting for their session. Large, because connections that never speak must
/// not keep others out, and each costs little more than its socket.
const PENDING: usize = 8192;

/// Returns the zenoh configuration common to coordinator and worker.
pub(super) fn common(locators: &[&Locator], tls: &Value) -> Value {
    // no other protocol than those asked for: a peer cannot choose a weaker one
    let protocols: BTreeSet<&str> = locators.iter().map(|at| at.protocol.zenoh_name()).collect();
    json!({
        "scouting": { "multicast": { "enabled": false }, "gossip": { "enabled": false } },
        "adminspace": { "enabled": false },
        // nobody reads the times of messages, and a wall clock that is wrong has no say here
        "timestamping": { "enabled": false },
        "transport": {
            "unicast": {
                "max_sessions": SESSIONS, "accept_pending": PENDING, "accept_timeout": ACCEPT_MS,
            },
            "link": {
                "protocols": protocols,
                "tx": {
                    "lease": 3000, "keep_alive": 6, "queue": { "size": { "data": QUEUED } },
                },
                "rx": { "max_message_size": 64 << 20 },
                "tls": tls,
            },
        },
    })
}

/// Returns the TLS section of the configuration of an end that connects.
pub(super) fn connecting(keys: &Keys) -> Value {
    json!({
        "root_ca_certificate": keys.ca(), "connect_certificate": keys.certificate(),
        "connect_private_key": keys.key(), "enable_mtls": true, "verify_name_on_connect": true,
        "close_link_on_expiration": true,
    })
}

/// Returns the key material if any of the addresses uses QUIC, `None` otherwise.
///
/// # Errors
/// [`LinkError::NoKeys`] if a QUIC address is given without key material.
pub(super) fn needed<'a>(
    locators: &[&Locator],
    keys: Option<&'a Keys>,
) -> Result<Option<&'a Keys>, LinkError> {
    let secured = locators
        .iter()
        .find(|locator| locator.protocol == Protocol::Quic);
    let Some(secured) = secured else {
        return Ok(None);
    };
    keys.map(Some).ok_or_else(|| LinkError::NoKeys {
        locator: secured.to_string(),
    })
}

/// Opens a session; `doing` describes the attempted action for the error message.
///
/// # Errors
/// [`LinkError::Transport`] with the error message of the bus.
pub(super) async fn open(config: &Value, doing: &str) -> Result<zenoh::Session, LinkError> {
    let config =
        zenoh::Config::from_json5(&config.to_string()).map_err(|error| transport(doing, &error))?;
    zenoh::open(config)
        .await
        .map_err(|error| transport(doing, &error))
}

/// Converts an error of the bus into a [`LinkError::Transport`].
pub(super) fn transport(doing: &str, reason: &dyn std::fmt::Display) -> LinkError {
    let reason = reason.to_string();
    // the transport adds where in its own source it noticed, which helps nobody here
    let words = reason.split(" at /").next().unwrap_or(&reason);
    LinkError::Transport {
        doing: doing.to_owned(),
        reason: words.trim_end_matches('.').to_owned(),
    }
}

/// Closes a session, but gives up after the time limit [`CLOSE`].
pub(super) async fn close(session: zenoh::Session) {
    if !matches!(
        tokio::time::timeout(CLOSE, async { session.close().await }).await,
        Ok(Ok(()))
    ) {
        tracing::debug!("the session did not close in time");
    }
}
