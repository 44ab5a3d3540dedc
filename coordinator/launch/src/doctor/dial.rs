//! Diagnosis from the worker's side: the same connection steps with the same certificates as a worker, up to
//! the first message from a coordinator.
use super::{
    check::{Check, Layer},
    classify::classify,
};
use link::{
    LinkError, WorkerEnd as _,
    keys::{KeyRole, Keys},
    locator::{Locator, Protocol},
    zenoh::ZenohWorker,
};
use protocol::{
    id::RunId,
    key::Lane,
    message::{FromWorker, Heartbeat, ToWorker},
    wire::{self, FrameKind, WireError},
};
use std::{path::Path, time::Duration};
use tokio::time::timeout;

/// Maximum number of heartbeats sent to the coordinator, one per second, while waiting for its reply: the
/// message bus needs a moment to establish its subscriptions.
const ASKED: u32 = 8;

/// Checks the layers on the way to a coordinator, up to the first that fails.
pub async fn dial(to: &Locator, tls: Option<&Path>) -> Vec<Check> {
    let mut checks = Vec::new();
    let keys = match tls
        .map(|folder| Keys::read(folder, KeyRole::Worker))
        .transpose()
    {
        Ok(keys) => keys,
        Err(error) => return vec![classify(&error.into())],
    };
    if let Some(keys) = &keys {
        let found = format!("\"{}\" of {}", keys.owner(), keys.certificate().display());
        checks.push(Check::good(Layer::Certificate, found));
        checks.push(Check::good(Layer::Clock, "within the certificate's dates"));
    }
    let mut link = match ZenohWorker::open(to, keys.as_ref(), u64::from(std::process::id())).await {
        Ok(link) => link,
        Err(error) => {
            let found = "passed: the connection failed only at a later layer";
            checks.extend(passed(&error).map(|layer| Check::good(layer, found)));
            checks.push(classify(&error));
            return checks;
        }
    };
    let answers = match to.protocol {
        Protocol::Unix => "the socket answers",
        Protocol::Tcp => "the port is open",
        Protocol::Quic => "both ends accept each other's certificate",
    };
    for layer in [Layer::Name, Layer::Route, Layer::Port, Layer::Firewall] {
        checks.push(Check::good(layer, answers));
    }
    checks.push(version(&mut link, to).await);
    link.close().await;
    checks
}

/// Returns the layers that are known to be healthy, given the error with which the connection failed.
fn passed(error: &LinkError) -> impl Iterator<Item = Layer> {
    let answered = matches!(
        error,
        LinkError::Distrusted { .. } | LinkError::Refused { .. }
    );
    let count = match classify(error).layer {
        Layer::Certificate | Layer::Clock if answered => 4,
        Layer::Case | Layer::Program | Layer::Certificate | Layer::Clock | Layer::Name => 0,
        Layer::Route => 1,
        Layer::Port | Layer::Firewall => 2,
        Layer::Version => 4,
    };
    [Layer::Name, Layer::Route, Layer::Port, Layer::Firewall]
        .into_iter()
        .take(count)
}

/// Checks that the coordinator uses the same protocol version: sends a heartbeat as an unknown worker, which
/// a coordinator answers with a request for identification and keeps no state of.
async fn version(link: &mut ZenohWorker, to: &Locator) -> Check {
    let run = RunId::default();
    let Ok(question) = wire::encode_frame(
        FrameKind::FromWorker,
        run,
        &FromWorker::Beat(Heartbeat::default()),
    ) else {
        return Check::bad(
            Layer::Version,
            "the test message cannot be encoded",
            "reinstall this program",
        );
    };
    for _ in 0..ASKED {
        link.send(run, Lane::Control, question.clone());
        if let Ok(heard) = timeout(Duration::from_secs(1), link.receive()).await {
            return heard.map_or_else(|| nobody(to), |frame| understood(&frame));
        }
    }
    nobody(to)
}

fn nobody(to: &Locator) -> Check {
    classify(&LinkError::Transport {
        doing: format!("hear a coordinator at {to}"),
        reason: "the address accepts connections, but no reply arrives over Zenoh".to_owned(),
    })
}

/// Checks that a message from the coordinator has this program's protocol version.
fn understood(frame: &[u8]) -> Check {
    const SAME: &str = "use the same build of horsehead and horsehead-worker on every machine";
    let own = wire::VERSION;
    match wire::decode_frame::<ToWorker>(FrameKind::ToWorker, frame) {
        Ok((run, _)) => Check::good(Layer::Version, format!("protocol {own}, run {run}")),
        Err(WireError::Version { found }) => Check::bad(
            Layer::Version,
            format!("the coordinator uses protocol version {found}, this program version {own}"),
            SAME,
        ),
        Err(error) => Check::bad(Layer::Version, error.to_string(), SAME),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_another_version_is_told_as_such() {
        let mut frame =
            wire::encode_frame(FrameKind::ToWorker, RunId(3), &ToWorker::Identify).unwrap();
        assert!(understood(&frame).healthy);
        // the version is the third byte of every frame, whatever comes after
        frame[2] += 1;
        let check = understood(&frame);
        assert_eq!((check.layer, check.healthy), (Layer::Version, false));
        assert!(
            check
                .found
                .contains(&format!("protocol version {}", wire::VERSION + 1)),
            "{check:?}"
        );
    }
}
