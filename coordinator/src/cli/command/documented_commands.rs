//! Test that every command line quoted in error messages, notes, reports, help texts and READMEs is accepted
//! by the argument parser. Searches the string literals and doc comments of the sources.
use super::*;
use std::{
    fs,
    path::{Path, PathBuf},
};

const PLACES: &[&str] = &[
    "README.md",
    "cases",
    "coordinator",
    "deploy",
    "docs",
    "protocol",
    "tests",
    "worker",
];

const NAMES: &[&str] = &["horsehead authority", "horsehead blind suite"];

fn texts(place: &Path, found: &mut Vec<PathBuf>) {
    let hidden = place.ends_with("target") || place.ends_with("fuzz");
    if place.is_dir() && !hidden {
        for entry in fs::read_dir(place).unwrap() {
            texts(&entry.unwrap().path(), found);
        }
    }
    let ending = place.extension().and_then(|ending| ending.to_str());
    let known = [
        "rs", "md", "sh", "toml", "service", "yaml", "yml", "slurm", "sbatch",
    ];
    if place.is_file() && ending.is_some_and(|ending| known.contains(&ending)) {
        found.push(place.to_owned());
    }
}

/// Extracts the user-visible text of a Rust source: its string literals and its doc comments.
fn user_visible_texts(source: &str) -> Vec<String> {
    let mut all = Vec::new();
    let docs = source.lines().map(str::trim_start);
    let docs = docs.filter_map(|line| line.strip_prefix("//!").or(line.strip_prefix("///")));
    all.push(docs.collect::<Vec<_>>().join("\n"));
    let code = source
        .lines()
        .filter(|line| !line.trim_start().starts_with("//"));
    let code: Vec<char> = code.collect::<Vec<_>>().join("\n").chars().collect();
    let mut at = 0;
    while at < code.len() {
        if code[at] == '\'' && code.get(at + 2) == Some(&'\'') {
            at += 3;
        } else if code[at] == '"' {
            let mut literal = String::new();
            at += 1;
            while at < code.len() && code[at] != '"' {
                match (code[at], code.get(at + 1)) {
                    ('\\', Some('\n')) => {
                        // a continued line goes on behind its indentation
                        at += 2;
                        while code.get(at).is_some_and(|c| c.is_whitespace()) {
                            at += 1;
                        }
                        continue;
                    }
                    ('\\', Some('n')) => literal.push('\n'),
                    ('\\', Some(other)) => literal.push(*other),
                    (other, _) => {
                        literal.push(other);
                        at += 1;
                        continue;
                    }
                }
                at += 2;
            }
            all.push(literal);
            at += 1;
        } else {
            at += 1;
        }
    }
    all
}

/// Extracts the command lines of a text: those in backticks, at the beginning of a line, or preceded by a
/// path.
fn commands_of(text: &str) -> Vec<String> {
    let text = text.replace("\\\n", " ");
    let mut found = Vec::new();
    for line in text.lines() {
        for (at, _) in line.match_indices("horsehead ") {
            let (before, command) = line.split_at(at);
            let end = if before.ends_with('`') {
                command.find('`')
            } else if before.trim().is_empty() || before.ends_with(['/', '$']) {
                let ends = ["  ", " # ", " > ", " | ", "`", " && ", "; "];
                ends.iter().filter_map(|end| command.find(end)).min()
            } else {
                continue;
            };
            let command = command.get(..end.unwrap_or(command.len())).unwrap();
            let named = NAMES.iter().any(|name| command.starts_with(name));
            let version = command.starts_with("horsehead 0.");
            if named || version {
                continue;
            }
            found.push(command.trim_end_matches(['.', ',', ':', ' ']).to_owned());
        }
    }
    found
}

/// Replaces a placeholder in a command line, such as `{x}`, `CASE` or `KEY=VALUE`, by a valid argument;
/// returns other words unchanged.
fn typed(word: &str, before: &str) -> String {
    let placeholder = |word: &str| {
        let capital = word
            .chars()
            .all(|c| c.is_ascii_uppercase() || "|=_".contains(c));
        !word.is_empty() && (capital || word.contains('{') || word.starts_with('<'))
    };
    match (placeholder(word), before) {
        (true, "--preset" | "presets") => "quick".to_owned(),
        (true, "--set") => "population=40".to_owned(),
        (true, _) => "1".to_owned(),
        (false, _) => word.to_owned(),
    }
}

/// Returns the parser's error for a command line, or `None` if it is valid.
fn problem_of(command: &str) -> Option<String> {
    let words = shlex::split(command).unwrap_or_else(|| vec![command.to_owned()]);
    // the name of a command alone is mentioned, not to be typed
    let mut description = Some(&Cli::command()).cloned();
    for word in words.iter().skip(1) {
        description = description.and_then(|one| one.find_subcommand(word).cloned());
    }
    let whole = words.iter().skip(1).any(|word| word.starts_with('{'));
    if description.is_some() || (whole && words.get(1).is_some_and(|word| word.starts_with('{'))) {
        return None;
    }
    let before = std::iter::once("").chain(words.iter().map(String::as_str));
    let words = words
        .iter()
        .zip(before)
        .map(|(word, before)| typed(word, before));
    match Cli::try_parse_from(words) {
        Ok(_) => None,
        Err(error) if !error.use_stderr() => None,
        Err(error) => Some(error.to_string()),
    }
}

#[test]
fn every_command_that_is_written_down_can_be_typed() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = Vec::new();
    for place in PLACES {
        texts(&root.join(place), &mut files);
    }
    let (mut seen, mut wrong) = (0, Vec::new());
    for file in files
        .iter()
        .filter(|file| !file.ends_with("command/documented_commands.rs"))
    {
        let text = fs::read_to_string(file).unwrap();
        let is_source = file.extension().is_some_and(|ending| ending == "rs");
        let texts = if is_source {
            user_visible_texts(&text)
        } else {
            vec![text]
        };
        for command in texts.iter().flat_map(|text| commands_of(text)) {
            seen += 1;
            let place = file.strip_prefix(&root).unwrap().display();
            wrong.extend(problem_of(&command).map(|why| format!("{place}: {command}\n{why}")));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(seen > 100, "{seen} commands are not all of them");
}

#[test]
fn a_command_with_an_unknown_flag_or_value_is_found_wherever_it_stands() {
    let source = r#"
        //! See `horsehead calibrate CASE --presets quick`.
        let help = "try\n  horsehead calibrate {case} --preset deep";
        let fine = format!("`horsehead report {run}` or `horsehead calibrate`: \
                            `horsehead case check CASE`");
    "#;
    let commands: Vec<String> = user_visible_texts(source)
        .iter()
        .flat_map(|text| commands_of(text))
        .collect();
    assert_eq!(commands.len(), 5, "{commands:?}");
    let wrong: Vec<bool> = commands
        .iter()
        .map(|one| problem_of(one).is_some())
        .collect();
    assert_eq!(wrong, [true, true, false, false, false], "{commands:?}");
}
