//! Command lines that are printed or kept, as a shell takes them.
use std::path::Path;

/// The command line as it was typed, quoted where a shell needs it.
pub(crate) fn command_line() -> String {
    let typed = std::env::args().skip(1);
    let words = std::iter::once("horsehead".to_owned()).chain(typed);
    words.map(|word| quote(&word)).collect::<Vec<_>>().join(" ")
}

/// A word as a shell takes it.
pub(crate) fn quote(word: &str) -> String {
    // the system gives no word with a zero byte, which alone has no form that a shell takes
    shlex::try_quote(word).map_or_else(|_| word.to_owned(), std::borrow::Cow::into_owned)
}

/// A path as a shell takes it.
pub(crate) fn quote_path(path: &Path) -> String {
    quote(&path.display().to_string())
}
