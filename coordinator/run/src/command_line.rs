//! Shell quoting of command lines that are printed or stored.
use std::path::Path;

/// Returns the command line of this process, quoted for a shell.
pub fn command_line() -> String {
    let typed = std::env::args().skip(1);
    let words = std::iter::once("horsehead".to_owned()).chain(typed);
    words.map(|word| quote(&word)).collect::<Vec<_>>().join(" ")
}

/// Quotes a word for a shell.
pub(crate) fn quote(word: &str) -> String {
    // the system gives no word with a zero byte, which alone has no form that a shell takes
    shlex::try_quote(word).map_or_else(|_| word.to_owned(), std::borrow::Cow::into_owned)
}

/// Quotes a path for a shell.
pub fn quote_path(path: &Path) -> String {
    quote(&path.display().to_string())
}
