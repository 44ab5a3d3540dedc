//! Short identifier defined by a model, stored inline so that it can be copied.
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use std::fmt;

/// Identifier of up to 31 lower-case letters, digits and `_`, such as `step_underflow`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Identifier {
    letters: [u8; Self::MAX_LENGTH],
    length: u8,
}

impl Identifier {
    /// Maximum length of an identifier (bytes).
    pub const MAX_LENGTH: usize = 31;

    /// Creates an identifier; `None` if the text is too long or contains other characters than lower-case
    /// letters, digits and `_`.
    pub const fn parse(text: &str) -> Option<Self> {
        let bytes = text.as_bytes();
        if bytes.len() > Self::MAX_LENGTH {
            return None;
        }
        let mut letters = [0; Self::MAX_LENGTH];
        let mut at = 0;
        while at < bytes.len() {
            if !matches!(bytes[at], b'a'..=b'z' | b'0'..=b'9' | b'_') {
                return None;
            }
            letters[at] = bytes[at];
            at += 1;
        }
        #[expect(
            clippy::cast_possible_truncation,
            reason = "not above the length of a word"
        )]
        let length = bytes.len() as u8;
        Some(Self { letters, length })
    }

    /// Creates an identifier from a text that is part of the program.
    ///
    /// # Panics
    /// If the text is not a valid identifier; for a constant, at compile time.
    pub const fn new(text: &str) -> Self {
        Self::parse(text).expect("a word of small letters, digits and `_`")
    }

    /// Returns the identifier as text.
    pub fn as_str(&self) -> &str {
        let letters = self
            .letters
            .get(..usize::from(self.length))
            .unwrap_or_default();
        std::str::from_utf8(letters).unwrap_or_default()
    }

    /// Returns the identifier with spaces in place of `_`, for use in a sentence.
    pub fn with_spaces(&self) -> String {
        self.as_str().replace('_', " ")
    }
}

impl fmt::Debug for Identifier {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(self.as_str())
    }
}

impl fmt::Display for Identifier {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str(self.as_str())
    }
}

impl Serialize for Identifier {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(self.as_str())
    }
}

impl<'de> Deserialize<'de> for Identifier {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let text = String::deserialize(from)?;
        Self::parse(&text).ok_or_else(|| D::Error::custom(format!("\"{text}\" is not a valid identifier: at most 31 lower-case letters, digits and `_`")))
    }
}

#[cfg(test)]
mod tests {
    use super::Identifier;

    #[test]
    fn a_word_comes_back_and_anything_else_is_refused() {
        let word = Identifier::new("step_underflow");
        assert_eq!(
            (word.as_str(), word.with_spaces().as_str()),
            ("step_underflow", "step underflow")
        );
        let bytes = crate::wire::encode(&word).unwrap();
        assert_eq!(crate::wire::decode::<Identifier>(&bytes), Ok(word));
        for text in ["Two Words", "\u{1b}[2J", &"x".repeat(32)] {
            assert_eq!(Identifier::parse(text), None, "{text}");
            let bytes = crate::wire::encode(&text).unwrap();
            assert!(crate::wire::decode::<Identifier>(&bytes).is_err(), "{text}");
        }
    }
}
