//! Which model a case is of, and what that model alone understands of it.
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// A model's own part of a case. Everybody else carries it as it is.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelSettings {
    /// Name of the kind of model; workers announce which kinds they simulate.
    pub kind: String,
    /// What the model alone understands; hexadecimal digits in files of text.
    #[serde(serialize_with = "write", deserialize_with = "read")]
    pub settings: Vec<u8>,
    /// How equal the results of equal jobs are.
    pub repeats: Repeats,
    /// How long one simulation may take (s), where the model itself ends it; none where that follows from how long
    /// others took.
    pub deadline_s: Option<f64>,
}

/// How equal the results of equal jobs are on all machines. Where their bits are not, the first result counts and
/// nobody is asked for the same thing twice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Repeats {
    /// Every bit of them.
    #[default]
    Bits,
    /// Values differ by no more than this share of their channel's root mean square.
    Within(f64),
    /// Nobody says.
    Unknown,
}

impl ModelSettings {
    /// Of a model that computes the same bits everywhere.
    pub const fn exact(kind: String, settings: Vec<u8>) -> Self {
        Self {
            kind,
            settings,
            repeats: Repeats::Bits,
            deadline_s: None,
        }
    }
}

fn write<S: Serializer>(bytes: &[u8], to: S) -> Result<S::Ok, S::Error> {
    if !to.is_human_readable() {
        return to.serialize_bytes(bytes);
    }
    let digit = |half: u8| char::from_digit(u32::from(half), 16).unwrap_or('0');
    let digits = bytes
        .iter()
        .flat_map(|byte| [digit(byte >> 4), digit(byte & 0xf)]);
    to.serialize_str(&digits.collect::<String>())
}

fn read<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<u8>, D::Error> {
    if !from.is_human_readable() {
        return serde_bytes::deserialize(from);
    }
    let text = String::deserialize(from)?;
    let digits = |pair: &[u8]| {
        let pair = std::str::from_utf8(pair)
            .ok()
            .filter(|pair| pair.len() == 2);
        pair.and_then(|pair| u8::from_str_radix(pair, 16).ok())
    };
    let bytes = text.as_bytes().chunks(2).map(digits).collect::<Option<_>>();
    bytes.ok_or_else(|| D::Error::custom("settings of a model are not pairs of hexadecimal digits"))
}
