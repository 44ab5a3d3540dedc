//! Check that output about the oscillator contains no terms of the pumping unit.
use std::{borrow::Cow, fs, path::Path};

/// Terms of the pumping unit, compared as whole alphanumeric words in lower case.
const FOREIGN: [&str; 23] = [
    "gauge",
    "gauges",
    "mpa",
    "mpa2",
    "stress",
    "crank",
    "cranks",
    "rope",
    "ropes",
    "card",
    "cards",
    "head",
    "heads",
    "pumping",
    "beam",
    "rod",
    "polished",
    "kb1",
    "cb1",
    "kc",
    "saddle",
    "rpm",
    "counterweight",
];

/// Checks that a text contains no foreign terms.
///
/// # Panics
/// If it contains one, showing the surrounding text.
pub(crate) fn check(place: &str, text: &str) {
    // a page has a head of its own
    let text = text.replace("<head>", "").replace("</head>", "");
    // and so has a journal
    let text = text.replace("journal.head", "");
    let lower = text.to_lowercase();
    for line in lower.lines() {
        let found = line
            .split(|c: char| !c.is_ascii_alphanumeric())
            .find(|word| FOREIGN.contains(word));
        let at = found.and_then(|word| line.find(word)).unwrap_or_default();
        let letters = line.chars().skip(at.saturating_sub(100));
        let around: String = letters.take(200).collect();
        assert_eq!(found, None, "{place} says it: {around}");
    }
}

/// Extracts words of more than three characters from binary data, as shorter ones occur by chance.
fn long_words(text: &str) -> String {
    let words = text.split(|c: char| !c.is_ascii_alphanumeric());
    let long: Vec<&str> = words.filter(|word| word.len() > 3).collect();
    long.join("\n")
}

/// Checks that all files of a folder, and their names, contain no foreign terms.
///
/// # Panics
/// If a file contains one, or the folder is empty.
pub(crate) fn check_folder(folder: &Path) {
    let mut read = 0;
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        check(
            &path.display().to_string(),
            &path.file_name().unwrap_or_default().to_string_lossy(),
        );
        if path.is_dir() {
            check_folder(&path);
        } else {
            let bytes = fs::read(&path).unwrap();
            let text = String::from_utf8_lossy(&bytes);
            // compressed bytes spell short words by chance, between dots that cannot be shown
            let spelt: String = match text {
                Cow::Borrowed(text) => text.to_owned(),
                Cow::Owned(text) => long_words(&text),
            };
            check(&path.display().to_string(), &spelt);
        }
        read += 1;
    }
    assert!(read > 0, "{} is empty", folder.display());
}
