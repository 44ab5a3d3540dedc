//! First line of template and instruction files: a keyword for the file type, and the delimiter.
use crate::{Problem, problem::clip};

/// Requirements on the first line of a template or instruction file.
pub(super) struct FirstLine {
    /// Keyword for the file type in the first line, e.g. `ptf`.
    pub(super) word: &'static str,
    /// Characters that may not be the delimiter, in addition to letters and digits.
    pub(super) forbidden_delimiters: &'static str,
    /// Description of a valid first line, for error messages.
    pub(super) allowed: &'static str,
    /// Remedy for an invalid first line, for error messages.
    pub(super) remedy: &'static str,
}

impl FirstLine {
    /// Reads the first line of a file and returns the delimiter and the text after this line.
    ///
    /// # Errors
    /// An invalid first line.
    pub(super) fn read<'a>(&self, file: &str, text: &'a str) -> Result<(char, &'a str), Problem> {
        let (first, body) = text.split_once('\n').unwrap_or((text, ""));
        let mut words = first.split_whitespace();
        let is_marked = words
            .next()
            .is_some_and(|word| word.eq_ignore_ascii_case(self.word));
        let mark = words.next().and_then(|word| {
            let mut letters = word.chars();
            let mark = letters.next()?;
            let is_free = !mark.is_alphanumeric() && !self.forbidden_delimiters.contains(mark);
            (letters.next().is_none() && is_free).then_some(mark)
        });
        mark.filter(|_| is_marked)
            .map(|mark| (mark, body))
            .ok_or_else(|| {
                let found = format!("`{}`", clip(first));
                Problem::at(file, 1, found, self.allowed, self.remedy)
            })
    }
}
