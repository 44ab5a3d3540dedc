//! Logging of refused connections: each reason at most once a minute, with a count of the occurrences
//! suppressed.
use std::{
    collections::BTreeMap,
    net::SocketAddr,
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};

/// Minimum interval between two log messages with the same reason for a refusal.
const PAUSE: Duration = Duration::from_mins(1);
/// Maximum number of characters of a peer's name in a message.
const SHOWN: usize = 64;

/// Reasons logged so far, each with the time of its last message and the number of occurrences suppressed
/// since.
#[derive(Debug, Default)]
pub(super) struct Refusals {
    told: Mutex<BTreeMap<&'static str, (Instant, u64)>>,
}

impl Refusals {
    /// Logs a failed handshake; `words` is the transport's error message.
    pub(super) fn warn(&self, from: SocketAddr, words: &str) {
        if let Some(reason) = reason(words) {
            self.say(from, reason, "");
        } else {
            tracing::debug!(%from, words, "a connection broke off");
        }
    }

    /// Logs a peer with a valid certificate whose name is not on the list of workers.
    pub(super) fn unlisted(&self, from: SocketAddr, owner: &str) {
        let shown: String = owner
            .chars()
            .take(SHOWN)
            .flat_map(char::escape_debug)
            .collect();
        let reason = "the list of workers does not hold the name of its certificate";
        self.say(from, reason, &format!(" (\"{shown}\")"));
    }

    /// Logs a peer whose certificate has reached its maximum number of connections.
    pub(super) fn crowded(&self, from: SocketAddr, owner: &str) {
        let reason = "its certificate has reached the maximum number of connections";
        self.say(from, reason, &format!(" (\"{owner}\")"));
    }

    fn say(&self, from: SocketAddr, reason: &'static str, detail: &str) {
        if let Some(more) = self.take_due(reason, Instant::now()) {
            let more = match more {
                0 => String::new(),
                more => format!("; {more} more since the last such message"),
            };
            tracing::warn!("a connection from {from} was refused: {reason}{detail}{more}");
        }
    }

    /// Returns the number of suppressed messages with this reason if the reason is due to be logged again,
    /// otherwise `None`.
    fn take_due(&self, reason: &'static str, now: Instant) -> Option<u64> {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        match told.get_mut(reason) {
            Some((at, unsaid)) if now.saturating_duration_since(*at) < PAUSE => {
                *unsaid += 1;
                None
            }
            earlier => {
                let unsaid = earlier.map_or(0, |(_, unsaid)| *unsaid);
                told.insert(reason, (now, 0));
                Some(unsaid)
            }
        }
    }
}

/// Translates the transport's error message into a reason for the log; `None` for connections that merely
/// broke off.
fn reason(words: &str) -> Option<&'static str> {
    let has = |part: &str| words.contains(part);
    if has("UnknownIssuer") || has("BadSignature") {
        Some("its certificate was signed by another authority than this coordinator's")
    } else if has("NotValidYet") || has("not valid yet") {
        Some("its certificate is not valid yet: compare the clocks of both machines")
    } else if has("expired") || has("Expired") {
        Some("its certificate is out of date")
    } else if has("no certificates") {
        Some("it showed no certificate")
    } else if has("invalid peer certificate") {
        Some("its certificate is not one for a worker")
    } else if has("application protocol") {
        Some("it is not a worker of this build")
    } else if has("unknown ca") || has("unknown CA") || has("UnknownCA") {
        Some("it does not trust this coordinator's authority")
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_is_told_once_a_minute_and_counted_meanwhile() {
        let (refusals, now) = (Refusals::default(), Instant::now());
        let unknown = reason("the cryptographic handshake failed: UnknownIssuer").unwrap();
        let none = reason("peer sent no certificates").unwrap();
        assert_eq!(refusals.take_due(unknown, now), Some(0));
        assert_eq!(refusals.take_due(unknown, now + PAUSE / 2), None);
        assert_eq!(refusals.take_due(none, now), Some(0));
        assert_eq!(refusals.take_due(unknown, now + PAUSE * 2), Some(1));
        assert_eq!(reason("timed out"), None);
    }
}
