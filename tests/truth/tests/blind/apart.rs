//! Checks that the programs under test contain no string of this crate.
use std::{fs, path::Path};

/// Strings that occur only in this crate and in its compiled program, so that finding one elsewhere reveals a
/// leak.
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

#[test]
fn no_word_of_the_truth_is_in_the_programs_that_are_judged() {
    let own = fs::read(env!("CARGO_BIN_EXE_truth")).unwrap();
    for word in WORDS {
        assert!(
            holds(&own, word),
            "the test looks for the wrong words: {word}"
        );
    }
    for name in ["horsehead", "horsehead-worker"] {
        // `cargo test --workspace` and `cargo build` put them beside ours
        let program = Path::new(env!("CARGO_BIN_EXE_truth")).with_file_name(name);
        let program = fs::read(program).unwrap();
        for word in WORDS {
            assert!(!holds(&program, word), "{name} knows of {word}");
        }
    }
}
