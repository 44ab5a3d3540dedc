//! Checks that words of one machine, such as rope or gauge, occur only in listed files; all other code must
//! be independent of the model.
use std::{
    fs,
    path::{Path, PathBuf},
};

/// Rule that bans words from folders.
struct Rule {
    /// Folders and files in which the words are banned, relative to the workspace root.
    within: &'static [&'static str],
    /// Banned words; a word in lower case is banned in any case, a word with capitals only as written.
    words: &'static [&'static str],
    /// Folders and files that may contain the banned words.
    except: &'static [&'static str],
}

/// Source folders that must be independent of the model.
const GENERAL: &[&str] = &[
    "protocol/src",
    "protocol/link/src",
    "worker/src",
    "coordinator/search/src",
    "coordinator/discrepancy/src",
    "coordinator/case/src",
    "coordinator/dispatch/src",
    "coordinator/launch/src",
    "coordinator/report/src",
    "coordinator/store/src",
    "coordinator/study/src",
    "coordinator/run/src",
    "coordinator/dashboard/src",
    "coordinator/src",
];

/// Banned words per folder: code first written for ten rope coefficients and four gauges must work for any
/// unknowns and channels.
const RULES: &[Rule] = &[
    Rule {
        within: &[
            "coordinator/search/src",
            "coordinator/discrepancy/src",
            "coordinator/dispatch/src",
        ],
        words: &["kb1", "mpa", "mpa2", "Coefficient"],
        except: &[],
    },
    Rule {
        within: GENERAL,
        words: &[
            "gauge", "gauges", "crank", "cranks", "rope", "ropes", "card", "cards", "mpa", "mpa2",
            "kb1",
        ],
        except: &[
            "protocol/src/pumping_unit",
            "worker/src/pumping_unit",
            "coordinator/src/cli/command/head",
            "coordinator/src/cli/command/balance",
            "coordinator/src/cli/command/life",
            "coordinator/src/cli/command/record.rs",
            "coordinator/src/cli/output/model/pumping_unit",
            "coordinator/src/cli/output/object/pumping_unit_tests.rs",
            "coordinator/case/src/pumping_unit",
            "coordinator/report/src/pumping_unit",
            // tests that take the shipped case or its effects for an example
            "coordinator/case/src/effect_text.rs",
            "coordinator/src/cli/command/export/tests.rs",
            "coordinator/src/cli/command/tests.rs",
            "coordinator/src/cli/output/object/diagnosis/tests.rs",
            "coordinator/src/cli/output/object/identification/tests.rs",
            "coordinator/study/src/tests.rs",
            "coordinator/study/src/test_evaluator.rs",
        ],
    },
];

#[test]
fn the_words_of_a_machine_stay_with_it() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let (mut said, mut read) = (Vec::new(), 0);
    for rule in RULES {
        for file in rule
            .within
            .iter()
            .flat_map(|part| sources(&root.join(part)))
        {
            let place = file.strip_prefix(&root).expect("inside");
            if rule.except.iter().any(|part| place.starts_with(part)) {
                continue;
            }
            read += 1;
            let text = fs::read_to_string(&file).expect("a source");
            for (number, line) in text.lines().enumerate() {
                if let Some(word) = words(line).find(|word| rule.forbids(word)) {
                    said.push(format!("{}:{}: {word}", place.display(), number + 1));
                }
            }
        }
    }
    assert!(read > 100, "only {read} files were read");
    assert!(said.is_empty(), "{}", said.join("\n"));
}

impl Rule {
    fn forbids(&self, word: &str) -> bool {
        let lower = word.to_lowercase();
        self.words.iter().any(|one| *one == word || *one == lower)
    }
}

/// Splits a line into words, also inside identifiers: `GaugeTrace` and `gauge_mpa` give two words each.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !c.is_ascii_alphanumeric())
        .flat_map(|part| {
            let capital = |at: &usize| {
                let bytes = part.as_bytes();
                bytes[*at].is_ascii_uppercase() && bytes[*at - 1].is_ascii_lowercase()
            };
            let cuts: Vec<usize> = (1..part.len()).filter(capital).collect();
            let begins = [0].into_iter().chain(cuts.clone());
            let ends = cuts.into_iter().chain([part.len()]);
            begins.zip(ends).filter_map(|(from, to)| part.get(from..to))
        })
}

/// Returns every Rust source below a folder, or the path itself if it is a file.
pub(crate) fn sources(at: &Path) -> Vec<PathBuf> {
    if at.is_file() {
        return vec![at.to_owned()];
    }
    let entries = fs::read_dir(at).unwrap_or_else(|error| panic!("{}: {error}", at.display()));
    let inside = entries.flat_map(|entry| {
        let path = entry.expect("an entry").path();
        let is_source = path.extension().is_some_and(|end| end == "rs");
        if path.is_dir() || is_source {
            sources(&path)
        } else {
            Vec::new()
        }
    });
    inside.collect()
}

#[test]
fn words_are_found_inside_identifiers() {
    let found: Vec<&str> =
        words("let GaugeTrace { mean_mpa } = kb1[3]; // MPa, coefficient").collect();
    let found: Vec<&str> = found.into_iter().filter(|word| !word.is_empty()).collect();
    let expected = [
        "let",
        "Gauge",
        "Trace",
        "mean",
        "mpa",
        "kb1",
        "3",
        "MPa",
        "coefficient",
    ];
    assert_eq!(found, expected);
    let forbidden: Vec<&str> = found
        .into_iter()
        .filter(|word| RULES[0].forbids(word))
        .collect();
    assert_eq!(forbidden, ["mpa", "kb1", "MPa"]);
}
