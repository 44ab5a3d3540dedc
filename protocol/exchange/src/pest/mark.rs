//! The first line of templates and instructions: a word that says which of the two a file is, and the delimiter that
//! it uses.
use crate::{Problem, problem::clip};

/// What such a line must be.
pub(super) struct Marked {
    /// The word, as `ptf`.
    pub(super) word: &'static str,
    /// What no delimiter may be, beside letters and digits.
    pub(super) barred: &'static str,
    /// What the line must be, in words.
    pub(super) allowed: &'static str,
    /// What to do where it is not.
    pub(super) remedy: &'static str,
}

impl Marked {
    /// The delimiter, and the lines behind it.
    ///
    /// # Errors
    /// Another first line.
    pub(super) fn read<'a>(&self, file: &str, text: &'a str) -> Result<(char, &'a str), Problem> {
        let (first, body) = text.split_once('\n').unwrap_or((text, ""));
        let mut words = first.split_whitespace();
        let is_marked = words
            .next()
            .is_some_and(|word| word.eq_ignore_ascii_case(self.word));
        let mark = words.next().and_then(|word| {
            let mut letters = word.chars();
            let mark = letters.next()?;
            let is_free = !mark.is_alphanumeric() && !self.barred.contains(mark);
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
