//! A session of either end: what it is made of, how it is opened and closed.
use crate::{
    LinkError,
    keys::Keys,
    locator::{Locator, Protocol},
};
use serde_json::{Value, json};
use std::{collections::BTreeSet, time::Duration};

/// Frames that may wait to be read before further ones are dropped (and repeated by their
/// senders).
pub(super) const INBOX: usize = 16 << 10;
/// Longest time that closing a session may take: with a dead peer zenoh needs 10 s.
const CLOSE: Duration = Duration::from_secs(2);

/// How long a peer may take to open a session once it is connected \[ms\]: silent ones hold the
/// places of others for so long.
const ACCEPT_MS: u64 = 4000;

/// Sessions that an end holds. An idle one costs the coordinator its keep-alives, some 80 us a second:
/// this many leave it about nine tenths of its rate, twice as many seven (`tests/README.md`).
const SESSIONS: usize = 1000;

/// Connections that may be waiting for their session: those that never speak must not keep others
/// out, and each takes little more than its socket.
const PENDING: usize = 8192;

/// What a session of either end is made of.
pub(super) fn common(locators: &[&Locator], tls: &Value) -> Value {
    // no other protocol than those asked for: a peer cannot choose a weaker one
    let protocols: BTreeSet<&str> = locators.iter().map(|at| at.protocol.name()).collect();
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
                "tx": { "lease": 3000, "keep_alive": 6 },
                "rx": { "max_message_size": 64 << 20 },
                "tls": tls,
            },
        },
    })
}

/// The key material of an end that connects, as the bus takes it.
pub(super) fn connecting(keys: &Keys) -> Value {
    json!({
        "root_ca_certificate": keys.ca(), "connect_certificate": keys.certificate(),
        "connect_private_key": keys.key(), "enable_mtls": true, "verify_name_on_connect": true,
        "close_link_on_expiration": true,
    })
}

/// The key material that some addresses need: that of the first QUIC one, if there is one.
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

/// Opens a session.
///
/// # Errors
/// [`LinkError::Transport`] in the words of the bus; `doing` is what was tried.
pub(super) async fn open(config: &Value, doing: &str) -> Result<zenoh::Session, LinkError> {
    let config =
        zenoh::Config::from_json5(&config.to_string()).map_err(|error| transport(doing, &error))?;
    zenoh::open(config)
        .await
        .map_err(|error| transport(doing, &error))
}

/// What the bus says of something that was tried.
pub(super) fn transport(doing: &str, reason: &dyn std::fmt::Display) -> LinkError {
    let reason = reason.to_string();
    // the transport adds where in its own source it noticed, which helps nobody here
    let words = reason.split(" at /").next().unwrap_or(&reason);
    LinkError::Transport {
        doing: doing.to_owned(),
        reason: words.trim_end_matches('.').to_owned(),
    }
}

/// Closes a session, within reason.
pub(super) async fn close(session: zenoh::Session) {
    if !matches!(
        tokio::time::timeout(CLOSE, async { session.close().await }).await,
        Ok(Ok(()))
    ) {
        tracing::debug!("the session did not close in time");
    }
}
