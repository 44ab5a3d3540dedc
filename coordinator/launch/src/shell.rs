//! Quoting of command lines for a shell, and parsing of `KEY=VALUE` options.
use support::Problem;

/// Quotes words as one shell command line.
pub(super) fn line(words: &[String]) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_=+.,/:@%".contains(c);
    let quoted = words.iter().map(|word| {
        if !word.is_empty() && word.chars().all(plain) {
            word.clone()
        } else {
            format!("'{}'", word.replace('\'', r"'\''"))
        }
    });
    quoted.collect::<Vec<_>>().join(" ")
}

/// Returns the text with a newline after every line.
pub(super) fn lines(text: &str) -> String {
    text.lines().flat_map(|line| [line, "\n"]).collect()
}

/// Parses an option of the form `KEY=VALUE,KEY=VALUE`.
///
/// # Errors
/// If a part has no `=`, or its key is not in a non-empty `known`.
pub(super) fn settings(
    option: &str,
    text: &str,
    known: &[&str],
) -> Result<Vec<(String, String)>, Problem> {
    let parts = text.split(',').filter(|part| !part.is_empty());
    parts
        .map(|part| match part.split_once('=') {
            Some((key, value))
                if !value.is_empty() && (known.is_empty() || known.contains(&key)) =>
            {
                Ok((key.to_owned(), value.to_owned()))
            }
            _ => Err(Problem::new(
                format!("{option} {text}: \"{part}\" is not understood"),
                if known.is_empty() {
                    format!("write KEY=VALUE, as {option} nodes=4,time=02:00:00")
                } else {
                    format!("write KEY=VALUE with one of {}", known.join(", "))
                },
            )),
        })
        .collect()
}
