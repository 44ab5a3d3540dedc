//! Tests of `horsehead doctor` on loopback: each network layer fails once and is reported with a remedy.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests: a program that cannot be run or read has failed"
)]
use link::keys::authority::{Authority, Validity};
use serde_json::Value;
use std::{
    net::{TcpListener, UdpSocket},
    path::Path,
    process::{Child, Command, Stdio},
    time::{Duration, Instant, SystemTime},
};

/// Runs `horsehead doctor` and returns the object that it prints, and its exit code.
fn doctor(words: &[&str]) -> (Value, Option<i32>) {
    let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
        .arg("doctor")
        .args(words)
        .args(["--output", "json"])
        .env_remove("HORSEHEAD_TLS")
        .output()
        .unwrap();
    let object = serde_json::from_slice(&output.stdout);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (object.unwrap_or(Value::String(said)), output.status.code())
}

/// Asserts that `horsehead doctor` reports the given network layer as failed and checks no layer after it.
fn fails(words: &[&str], layer: &str) {
    let (object, code) = doctor(words);
    assert_eq!(
        (code, &object["healthy"]),
        (Some(1), &false.into()),
        "{object}"
    );
    let checks = object["checks"].as_array().unwrap();
    let (last, before) = checks.split_last().unwrap();
    assert_eq!(last["layer"], layer, "{object}");
    assert_eq!(last["healthy"], false, "{object}");
    assert!(!last["remedy"].as_str().unwrap().is_empty(), "{object}");
    assert!(
        before.iter().all(|check| check["healthy"] == true),
        "{object}"
    );
}

/// Creates a certificate authority with a coordinator certificate for loopback and worker certificates of the
/// given validity.
fn keys(folder: &Path, workers: &[(&str, Validity)]) {
    let authority = Authority::create(folder).unwrap();
    let hosts = ["127.0.0.1".to_owned(), "localhost".to_owned()];
    authority
        .issue_coordinator(&hosts, Validity::days(1))
        .unwrap();
    for (name, valid) in workers {
        authority.issue_worker(name, *valid).unwrap();
    }
}

#[test]
fn every_layer_is_named_from_a_workers_side() {
    fails(&["--connect", "tcp/no-such-host.invalid:7447"], "name");
    // nobody can be spoken to at an address of many
    fails(&["--connect", "tcp/224.0.0.1:7447"], "route");
    let closed = TcpListener::bind("127.0.0.1:0").and_then(|socket| socket.local_addr());
    fails(&["--connect", &format!("tcp/{}", closed.unwrap())], "port");
    fails(&["--connect", "quic/127.0.0.1:7447"], "certificate");
    let scratch = tempfile::tempdir().unwrap();
    let later = Validity {
        from: SystemTime::now() + Duration::from_hours(24),
        until: SystemTime::now() + Duration::from_hours(48),
    };
    let folder = scratch.path().join("keys");
    keys(
        &folder,
        &[("worker-01", Validity::days(1)), ("later", later)],
    );
    let of = |name: &str| folder.join(name).display().to_string();
    fails(
        &["--connect", "quic/127.0.0.1:7447", "--tls", &of("later")],
        "clock",
    );
    fails(
        &["--connect", "quic/127.0.0.1:7447", "--tls", &of("nobody")],
        "certificate",
    );
    // it takes what comes and says nothing, as a firewall
    let mute = UdpSocket::bind("127.0.0.1:0").unwrap();
    let at = format!("quic/{}", mute.local_addr().unwrap());
    fails(&["--connect", &at, "--tls", &of("worker-01")], "firewall");
    // it listens, and is no coordinator
    let other = TcpListener::bind("127.0.0.1:0").unwrap();
    fails(
        &["--connect", &format!("tcp/{}", other.local_addr().unwrap())],
        "version",
    );
}

#[test]
fn every_layer_is_named_from_the_coordinators_side() {
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("keys");
    keys(&folder, &[("worker-01", Validity::days(1))]);
    let tls = folder.display().to_string();
    let (object, code) = doctor(&["--listen", "quic/127.0.0.1:0", "--tls", &tls]);
    assert_eq!(
        (code, &object["healthy"]),
        (Some(0), &true.into()),
        "{object}"
    );
    assert_eq!(
        (&object["side"], &object["locator"]),
        (&"coordinator".into(), &"quic/127.0.0.1:0".into())
    );
    let keys: Vec<&String> = object["checks"][0].as_object().unwrap().keys().collect();
    assert_eq!(keys, ["found", "healthy", "layer", "remedy"]);
    fails(&["--listen", "quic/127.0.0.1:0"], "certificate");
    fails(&["--listen", "tcp/no-such-host.invalid:7447"], "name");
    fails(&["--listen", "tcp/192.0.2.1:7447"], "route");
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let at = format!("tcp/{}", taken.local_addr().unwrap());
    fails(&["--listen", &at], "port");
    fails(
        &[
            "--listen",
            &at,
            "--case",
            &scratch.path().display().to_string(),
        ],
        "case",
    );
    // without an address this machine is looked at: it has the program of workers beside this one
    assert_eq!(doctor(&[]).1, Some(0));
}

/// Coordinator process that waits for individuals on its standard input; killed when dropped.
struct Waiting(Child);

impl Waiting {
    fn start(scratch: &Path, at: &str, tls: Option<&Path>) -> Self {
        let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
        let mut command = Command::new(env!("CARGO_BIN_EXE_horsehead"));
        command
            .arg("evaluate")
            .arg(case)
            .args(["--workers", "0", "--listen", at]);
        command
            .arg("--run")
            .arg(scratch.join("run"))
            .env_remove("HORSEHEAD_TLS");
        if let Some(tls) = tls {
            command.arg("--tls").arg(tls);
        }
        let quiet = command
            .stdin(Stdio::piped())
            .stdout(Stdio::null())
            .stderr(Stdio::null());
        Self(quiet.spawn().unwrap())
    }
}

impl Drop for Waiting {
    fn drop(&mut self) {
        // fails only if it has ended by itself
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

#[test]
fn a_running_coordinator_is_found_healthy_but_by_strangers() {
    let scratch = tempfile::tempdir().unwrap();
    let (own, other) = (scratch.path().join("keys"), scratch.path().join("other"));
    for folder in [&own, &other] {
        keys(folder, &[("worker-01", Validity::days(1))]);
    }
    let free = UdpSocket::bind("127.0.0.1:0").and_then(|socket| socket.local_addr());
    let at = format!("quic/{}", free.unwrap());
    let coordinator = Waiting::start(scratch.path(), &at, Some(&own));
    let tls = own.join("worker-01").display().to_string();
    let begun = Instant::now();
    let words = ["--connect", at.as_str(), "--tls", tls.as_str()];
    let (object, code) = loop {
        let said = doctor(&words);
        // it takes a moment until it listens
        if said.1 == Some(0) || begun.elapsed() > Duration::from_mins(1) {
            break said;
        }
    };
    assert_eq!(
        (code, &object["healthy"]),
        (Some(0), &true.into()),
        "{object}"
    );
    let checks = object["checks"].as_array().unwrap();
    let layers: Vec<&str> = checks
        .iter()
        .map(|check| check["layer"].as_str().unwrap())
        .collect();
    assert_eq!(
        layers,
        [
            "certificate",
            "clock",
            "name",
            "route",
            "port",
            "firewall",
            "version"
        ]
    );
    let stranger = other.join("worker-01").display().to_string();
    fails(&["--connect", &at, "--tls", &stranger], "certificate");
    drop(coordinator);
}
