//! Kind of model of a case, with its model-specific settings.
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

/// Kind of model of a case with its settings, which only the model understands.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ModelSettings {
    /// Name of the kind of model; workers announce the kinds that they simulate.
    pub kind: String,
    /// Encoded settings understood only by the model; written as hexadecimal digits in text formats.
    #[serde(serialize_with = "write", deserialize_with = "read")]
    pub settings: Vec<u8>,
    /// Reproducibility of the model's results on different machines.
    pub repeats: Reproducibility,
    /// Time limit of one simulation (s), where the model enforces one itself; `None` if the limit follows
    /// from the duration of other simulations.
    pub deadline_s: Option<f64>,
}

/// Reproducibility of the results of equal jobs across machines. Where results are not bitwise equal, the
/// first result counts and no job is computed twice.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Reproducibility {
    /// Results of equal jobs are bitwise equal on all machines.
    #[default]
    Bits,
    /// Results differ by at most this fraction of the root mean square of each channel.
    Within(f64),
    /// Nothing is known about the reproducibility of the results.
    Unknown,
}

impl ModelSettings {
    /// Creates the settings of a model whose results are bitwise reproducible.
    pub const fn exact(kind: String, settings: Vec<u8>) -> Self {
        Self {
            kind,
            settings,
            repeats: Reproducibility::Bits,
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
