//! Refused connections, in words: the transport reports them as a lack of open files.
//!
//! A peer whose certificate is not accepted never becomes a worker, so nobody but the transport
//! knows of it. This listens to what the transport logs and says once a minute what is wrong.
use super::output;
use std::{
    collections::BTreeMap,
    fmt::{self, Write as _},
    sync::{Mutex, PoisonError},
    time::{Duration, Instant},
};
use tracing::{
    Event, Metadata, Subscriber,
    field::{Field, Visit},
};
use tracing_subscriber::layer::{Context, Layer};

/// Where the transport reports connections that it could not accept.
const SOURCE: &str = "zenoh_link_commons::quic";
/// How it begins to say so.
const WORDS: &str = "QUIC acceptor failed";
/// How often the same refusal is told.
const PAUSE: Duration = Duration::from_mins(1);

/// Hears of refused connections.
#[derive(Debug, Default)]
pub(super) struct Refusals {
    told: Mutex<BTreeMap<&'static str, (Instant, u64)>>,
}

impl Refusals {
    /// Whether an event may be about a refused connection.
    pub(super) fn concerns(metadata: &Metadata<'_>) -> bool {
        metadata.target().starts_with(SOURCE)
    }

    /// What to say about a refusal, unless it was said a moment ago.
    fn news(&self, message: &str, now: Instant) -> Option<String> {
        let reason = reason(message.strip_prefix(WORDS)?)?;
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        let earlier = told.get_mut(reason);
        let since = match earlier {
            Some((at, unsaid)) if now.saturating_duration_since(*at) < PAUSE => {
                *unsaid += 1;
                return None;
            }
            Some((_, unsaid)) => *unsaid,
            None => 0,
        };
        told.insert(reason, (now, 0));
        let mut text = format!("a connection was refused: {reason}");
        if since > 0 {
            // writing to a string does not fail
            let _written = write!(text, " ({since} more in the last minute)");
        }
        Some(text)
    }
}

/// The transport's reason in our words; none for connections that merely broke off.
fn reason(words: &str) -> Option<&'static str> {
    let has = |part: &str| words.contains(part);
    if has("UnknownIssuer") || has("BadSignature") {
        Some("its certificate was signed by another authority than this coordinator's")
    } else if has("NotValidYet") {
        Some("its certificate is not valid yet: compare the clocks of both machines")
    } else if has("Expired") || has("expired") {
        Some("its certificate is out of date")
    } else if has("NoCertificatesPresented") || has("no certificates") {
        Some("it showed no certificate")
    } else if has("invalid peer certificate") {
        Some("its certificate is not one for a worker")
    } else if has("UnknownCA") || has("unknown ca") || has("UnknownCa") {
        Some("it does not trust this coordinator's authority")
    } else {
        None
    }
}

impl<S: Subscriber> Layer<S> for Refusals {
    fn on_event(&self, event: &Event<'_>, _context: Context<'_, S>) {
        let mut message = Message(String::new());
        event.record(&mut message);
        if let Some(text) = self.news(&message.0, Instant::now()) {
            output::tell(&format!(" WARN {text}"));
        }
    }
}

/// The text of an event.
struct Message(String);

impl Visit for Message {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        if field.name() == "message" {
            // writing to a string does not fail
            let _written = write!(self.0, "{value:?}");
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_is_told_once_a_minute_and_nothing_else_is() {
        let (refusals, now) = (Refusals::default(), Instant::now());
        let unknown = "QUIC acceptor failed: TransportError(Error { code: Code::crypto(30), \
                       reason: \"invalid peer certificate: UnknownIssuer\" }) Hint: increase";
        let told = refusals.news(unknown, now).unwrap();
        assert!(told.contains("another authority"), "{told}");
        assert_eq!(refusals.news(unknown, now + PAUSE / 2), None);
        let none = "QUIC acceptor failed: reason: \"peer sent no certificates\"";
        assert!(
            refusals
                .news(none, now)
                .unwrap()
                .contains("showed no certificate")
        );
        let again = refusals.news(unknown, now + PAUSE * 2).unwrap();
        assert!(again.contains("(1 more in the last minute)"), "{again}");
        for other in ["QUIC acceptor failed: TimedOut", "Accepted", ""] {
            assert_eq!(refusals.news(other, now), None, "{other}");
        }
    }
}
