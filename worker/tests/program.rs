//! Tests of the worker program as started by a user. (This test target also makes `cargo test --workspace`
//! build the program that the cluster suite starts.)
use std::process::{Command, Output};

fn worker(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_horsehead-worker"))
        .args(arguments)
        .env_remove("HORSEHEAD_CONNECT")
        .output()
        .expect("the program starts")
}

fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

#[test]
fn a_wrong_command_line_is_refused_in_words() {
    for (arguments, words) in [
        (&[][..], "--connect <LOCATOR>"),
        (&["--connect", "nonsense"], "quic/HOST:7447"),
        (
            &["--connect", "tcp/127.0.0.1:7447", "--slots", "0"],
            "1..=4096",
        ),
    ] {
        let output = worker(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(
            said(&output).contains(words),
            "{arguments:?}: {}",
            said(&output)
        );
        assert!(output.stdout.is_empty(), "{arguments:?}");
    }
}

#[test]
fn help_shows_how_to_start_one() {
    let output = worker(&["--help"]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "HORSEHEAD_CONNECT",
        "--idle-timeout",
        "horsehead-worker --connect unix/sockets/bus",
    ] {
        assert!(text.contains(words), "{words} is missing in {text}");
    }
}

/// Checks that a worker without a coordinator waits, and exits normally after its idle timeout.
#[test]
fn a_worker_without_a_coordinator_ends_after_its_idle_time() {
    let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
    let port = listener.local_addr().unwrap().port();
    drop(listener);
    let output = worker(&[
        "--connect",
        &format!("tcp/127.0.0.1:{port}"),
        "--idle-timeout",
        "1",
    ]);
    assert_eq!(output.status.code(), Some(0), "{}", said(&output));
    assert!(
        !said(&output).contains('\u{1b}'),
        "colour without a terminal"
    );
}
