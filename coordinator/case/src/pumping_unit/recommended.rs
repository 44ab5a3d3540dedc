//! Recommended value of an unknown as a case file states it: a number, or the name of a formula. The formulas
//! are evaluated elsewhere.
use serde::{
    Deserialize,
    de::{self, Visitor},
};
use std::fmt;

/// Recommended value of an unknown as stated in the case file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Recommended {
    /// Recommended value as a number in the unit of the unknown.
    Value(f64),
    /// Formula that computes the recommended value.
    Formula(Formula),
}

/// Formula for a recommended value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Formula {
    /// Stiffness of a solid round bar of the joint's length (paper, Eq. 3).
    Eq3,
    /// Hertz contact stiffness of rope and head.
    Hertz,
}

impl Formula {
    const ALL: [Self; 2] = [Self::Eq3, Self::Hertz];
    const WORDS: &'static [&'static str] = &[Self::Eq3.word(), Self::Hertz.word()];

    /// Returns the name of the formula as it is written in case files.
    pub(super) const fn word(self) -> &'static str {
        match self {
            Self::Eq3 => "eq3",
            Self::Hertz => "hertz",
        }
    }
}

impl<'de> Deserialize<'de> for Recommended {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_any(NumberOrWord)
    }
}

struct NumberOrWord;

impl Visitor<'_> for NumberOrWord {
    type Value = Recommended;

    fn expecting(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        to.write_str("a number, \"eq3\" or \"hertz\"")
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Recommended, E> {
        Ok(Recommended::Value(value))
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Recommended, E> {
        Ok(Recommended::Value(value as f64))
    }

    fn visit_str<E: de::Error>(self, word: &str) -> Result<Recommended, E> {
        let named = Formula::ALL.into_iter().find(|known| known.word() == word);
        named
            .map(Recommended::Formula)
            .ok_or_else(|| E::unknown_variant(word, Formula::WORDS))
    }
}
