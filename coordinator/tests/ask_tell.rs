//! Tests of `horsehead ask-tell` from the side of the other program: lines of input and output, and the end
//! of a session.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of tests: a program that cannot be run or read has failed"
)]
use serde_json::{Value, json};
use std::{
    io::{BufRead as _, BufReader, Write as _},
    process::{Child, ChildStdin, ChildStdout, Command, Stdio},
};

/// Test client of a running `horsehead ask-tell` process.
struct Peer {
    child: Child,
    to: Option<ChildStdin>,
    from: BufReader<ChildStdout>,
}

impl Peer {
    fn new(strategy: &str) -> Self {
        let mut child = Command::new(env!("CARGO_BIN_EXE_horsehead"))
            .args(["ask-tell", strategy])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let to = child.stdin.take();
        let from = BufReader::new(child.stdout.take().unwrap());
        Self { child, to, from }
    }

    /// Sends a line to the process and returns its reply.
    fn say(&mut self, line: &str) -> Value {
        writeln!(self.to.as_mut().unwrap(), "{line}").unwrap();
        self.hear()
    }

    fn hear(&mut self) -> Value {
        let mut line = String::new();
        self.from.read_line(&mut line).unwrap();
        serde_json::from_str(&line).unwrap()
    }

    /// Closes the process's input and returns its final reply.
    fn hang_up(&mut self) -> Value {
        self.to = None;
        self.hear()
    }

    fn code(mut self) -> i32 {
        self.to = None;
        self.child.wait().unwrap().code().unwrap()
    }
}

/// Returns the opening line of a search with two unknowns, one on a log scale, whose minimum of 0 lies at 100
/// and 0.3; `more` is merged into it.
fn opening(more: &Value) -> String {
    let mut opening = json!({"space": [
        {"name": "k", "lower": 1.0, "upper": 1e6, "scale": "log"},
        {"name": "x", "lower": -1.0, "upper": 1.0, "scale": "linear", "start": 0.0},
    ]});
    let more = more.as_object().unwrap().clone();
    opening.as_object_mut().unwrap().extend(more);
    opening.to_string()
}

fn residual(point: &Value) -> [f64; 2] {
    let x = |k: usize| point["x"][k].as_f64().unwrap();
    [x(0).log10() - 2.0, x(1) - 0.3]
}

/// Returns the input line that reports the result of a proposed point, with its residual.
fn answer(point: &Value) -> Value {
    let residual = residual(point);
    let f: f64 = residual.iter().map(|r| r * r).sum();
    json!({"id": point["id"], "f": f, "residual": residual})
}

/// Checks that every strategy ends by itself, whether results are sent one per line in reverse order, or all
/// at once; the last line contains the best point.
#[test]
fn every_strategy_talks_to_its_end_in_any_order() {
    for preset in search::strategy::CATALOGUE {
        let ended = [false, true].map(|singly| {
            let mut peer = Peer::new(preset.name);
            let mut said = peer.say(&opening(&json!({"seed": 3, "budget": 300})));
            while let Some(points) = said["ask"].as_array() {
                let mut told: Vec<Value> = points.iter().map(answer).collect();
                assert!(!told.is_empty(), "{} waits for nothing", preset.name);
                let mut more = Vec::new();
                if singly {
                    while let Some(one) = told.pop() {
                        said = peer.say(&json!({"tell": [one]}).to_string());
                        // a strategy without batches may ask while points are open
                        let fresh = said["ask"].as_array().into_iter().flatten();
                        more.extend(fresh.cloned().collect::<Vec<_>>());
                        if said.get("done").is_none() {
                            told.extend(more.drain(..).map(|point| answer(&point)));
                        }
                    }
                } else {
                    said = peer.say(&json!({"tell": told}).to_string());
                }
            }
            assert_eq!(peer.code(), 0, "{}", preset.name);
            said
        });
        assert_eq!(ended[0], ended[1], "{}", preset.name);
        let [one, _] = ended;
        assert!(one["evaluations"].as_u64().unwrap() <= 300, "{one}");
        let again = answer(&one["best"]);
        assert_eq!(one["best"]["f"], again["f"], "{}", preset.name);
        assert!(one["best"]["f"].as_f64().unwrap() < 0.1, "{one}");
    }
}

/// Checks that a result may be sent as a residual without an objective: its sum of squares is then minimised.
#[test]
fn a_point_may_be_told_with_its_residual_alone() {
    let mut peer = Peer::new("least-squares");
    let mut said = peer.say(&opening(&json!({"budget": 200})));
    while let Some(points) = said["ask"].as_array() {
        let alone = |point: &Value| json!({"id": point["id"], "residual": residual(point)});
        let told: Vec<Value> = points.iter().map(alone).collect();
        said = peer.say(&json!({"tell": told}).to_string());
    }
    let again = answer(&said["best"]);
    assert_eq!(said["best"]["f"], again["f"], "{said}");
    assert!(said["best"]["f"].as_f64().unwrap() < 1e-6, "{said}");
}

/// Checks that an invalid line ends the session with an error that contains the expected word and with exit
/// code 2, and that earlier results are kept.
#[test]
fn what_cannot_be_taken_is_answered_and_nothing_is_lost() {
    for (line, word) in [
        (r#"{"tell": [{"id": 0, "f": 2.0}]}"#, "told before"),
        (r#"{"tell": [{"id": 9999, "f": 2.0}]}"#, "not asked for"),
        (
            r#"{"tell": [{"id": 1, "f": 2.0}, {"id": 1, "f": 2.0}]}"#,
            "twice",
        ),
        (r#"{"tell": [{"id": 1, "f": NaN}]}"#, "cannot be read"),
        (r#"{"tell": [{"id": 1, "f": 1e999}]}"#, "cannot be read"),
        (r#"{"tell": [{"id": 1, "f": null}]}"#, "no number"),
        (r#"{"tell": [{"id": 1, "f": 1, "failed": true}]}"#, "failed"),
        (r#"{"tell": [{"id": -1, "f": 1}]}"#, "cannot be read"),
        (r#"{"told": []}"#, "unknown field"),
        ("nonsense", "cannot be read"),
    ] {
        let mut peer = Peer::new("random");
        peer.say(&opening(&json!({})));
        let said = peer.say(r#"{"tell": [{"id": 0, "f": 1.5}]}"#);
        assert_eq!(said["ask"], json!([]), "{said}");
        let said = peer.say(line);
        let error = said["error"].as_str().unwrap();
        assert!(
            error.starts_with("line 3: ") && error.contains(word),
            "{said}"
        );
        assert_eq!(said["evaluations"], 1, "{said}");
        assert_eq!(said["best"]["f"], 1.5, "{said}");
        assert!(!said["help"].as_str().unwrap().is_empty());
        assert_eq!(peer.code(), 2, "{line}");
    }
}

/// Checks that a first input line with an invalid search space or settings is refused.
#[test]
fn a_first_line_that_makes_no_search_is_refused() {
    let axis = |lower: f64, upper: f64, scale: &str| json!({"space": [{"name": "x", "lower": lower, "upper": upper, "scale": scale}]});
    for (strategy, line, word) in [
        (
            "paper",
            opening(&json!({"settings": {"population": 3}})),
            "population",
        ),
        (
            "paper",
            opening(&json!({"settings": {"poplation": 30}})),
            "poplation",
        ),
        ("paper", opening(&json!({"budget": 0})), "budget"),
        ("random", axis(1.0, -1.0, "linear").to_string(), "space"),
        ("random", axis(-1.0, 1.0, "log").to_string(), "space"),
        ("random", json!({"space": []}).to_string(), "space"),
        ("random", axis(0.0, 1.0, "cubic").to_string(), "cubic"),
        ("random", "{}".to_owned(), "space"),
    ] {
        let mut peer = Peer::new(strategy);
        let said = peer.say(&line);
        let error = said["error"].as_str().unwrap();
        assert!(
            error.starts_with("line 1: ") && error.contains(word),
            "{said}"
        );
        assert_eq!(peer.code(), 2, "{line}");
    }
}

/// Checks that the end of the input ends the session: with the best point so far, or with an error if no
/// result was sent.
#[test]
fn the_end_of_the_input_ends_a_talk() {
    let mut peer = Peer::new("quick");
    assert!(
        peer.hang_up()["error"]
            .as_str()
            .unwrap()
            .contains("first line")
    );
    assert_eq!(peer.code(), 2);

    let mut peer = Peer::new("quick");
    peer.say(&opening(&json!({})));
    assert!(
        peer.hang_up()["error"]
            .as_str()
            .unwrap()
            .contains("no point was told")
    );
    assert_eq!(peer.code(), 2);

    let mut peer = Peer::new("quick");
    peer.say(&opening(&json!({})));
    // later than others that are still open
    peer.say(r#"{"tell": [{"id": 5, "f": 0.5}]}"#);
    let said = peer.hang_up();
    assert_eq!(said["done"], "input");
    assert_eq!(said["best"]["id"], 5, "{said}");
    assert_eq!(peer.code(), 0);
}

#[test]
fn an_evaluation_that_always_fails_is_told_so() {
    let mut peer = Peer::new("random");
    let mut said = peer.say(&opening(&json!({"budget": 20})));
    let points = said["ask"].as_array().unwrap().clone();
    assert_eq!(points.len(), 20);
    for point in points {
        said = peer.say(&json!({"tell": [{"id": point["id"], "failed": true}]}).to_string());
    }
    assert!(
        said["error"]
            .as_str()
            .unwrap()
            .contains("all of the 20 points failed"),
        "{said}"
    );
    assert_eq!(peer.code(), 2);
}
