//! Words of another machine, which must not occur in what is said of this one.
use std::{fs, path::Path};

/// Whole words, letters and digits between anything else.
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

/// Whether a text is free of them.
///
/// # Panics
/// If it is not, showing where.
pub(crate) fn check(place: &str, text: &str) {
    // a page has a head of its own
    let text = text.replace("<head>", "").replace("</head>", "");
    let lower = text.to_lowercase();
    for line in lower.lines() {
        let found = line
            .split(|c: char| !c.is_ascii_alphanumeric())
            .find(|word| FOREIGN.contains(word));
        let Some(word) = found else { continue };
        let at = line.find(word).unwrap_or_default();
        let around: String = line
            .chars()
            .skip(at.saturating_sub(100))
            .take(200)
            .collect();
        panic!("{place} says `{word}`: {around}");
    }
}

/// Whether every file of a folder is free of them, whatever is readable in it.
///
/// # Panics
/// If one is not.
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
            check(
                &path.display().to_string(),
                &String::from_utf8_lossy(&bytes),
            );
        }
        read += 1;
    }
    assert!(read > 0, "{} is empty", folder.display());
}
