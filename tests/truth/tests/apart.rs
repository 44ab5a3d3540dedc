//! The programs that are judged know nothing of the truth: no words of it are in them.
use std::{fs, path::PathBuf, process::Command};

/// What only this crate says; strings that a program keeps.
const WORDS: [&str; 5] = [
    "horsehead blind suite draws",
    "breakdown_over_rated_1",
    "saddle_cubic_spring",
    "loose_ballast",
    "sets sealed; commitment",
];

fn holds(program: &[u8], word: &str) -> bool {
    program
        .windows(word.len())
        .any(|window| window == word.as_bytes())
}

/// A program of the workspace beside this one.
fn beside(name: &str, package: &str) -> PathBuf {
    let program = PathBuf::from(env!("CARGO_BIN_EXE_truth")).with_file_name(name);
    if !program.is_file() {
        let built = Command::new(env!("CARGO"))
            .args(["build", "--quiet", "-p", package, "--bin", name])
            .status();
        assert!(
            built.is_ok_and(|status| status.success()),
            "{name} is built"
        );
    }
    program
}

#[test]
fn no_word_of_the_truth_is_in_the_programs_that_are_judged() {
    let own = fs::read(env!("CARGO_BIN_EXE_truth")).unwrap();
    for word in WORDS {
        assert!(
            holds(&own, word),
            "the test looks for the wrong words: {word}"
        );
    }
    for (name, package) in [("horsehead", "coordinator"), ("horsehead-worker", "worker")] {
        let program = fs::read(beside(name, package)).unwrap();
        for word in WORDS {
            assert!(!holds(&program, word), "{name} knows of {word}");
        }
    }
}
