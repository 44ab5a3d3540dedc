//! Wire format of curves: about one byte per sample instead of eight.
//!
//! A curve whose values are whole multiples of a power of two, within limits, is encoded by those multiples:
//! the exponent, then differences of the multiples, which are small where a curve is smooth. A sender that
//! wants small messages therefore rounds curves ([`rounded`]) to a step far below their accuracy; a receiver
//! needs no table of steps. Any other curve (a number that is not finite, a negative zero, too wide a range)
//! is encoded as doubles. Both forms are lossless.
//!
//! ```text
//! | nothing                                                          an empty curve
//! | 255 | double ...                                                 as it is
//! | order u8 | width u8 | exponent i16 | samples u32 | code ...      multiples of 2^exponent
//! ```
//!
//! The code is a Rice code: a difference, with its sign in the lowest bit, is split above its `width` lowest
//! bits; the upper part is written in unary, as that number of ones and a zero, followed by the lowest bits.
//! After 24 ones the whole difference follows.
//!
//! A field is given this format by `#[serde(with = "crate::curve")]`, a list of curves by `#[serde(with =
//! "crate::curve::each")]`.
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

mod bits;
mod form;
#[cfg(test)]
mod tests;

/// Rounds a curve to whole multiples of two to the power of `exponent`; numbers that are not finite are
/// unchanged.
pub fn rounded(curve: &[f64], exponent: i32) -> Vec<f64> {
    let step = form::power(exponent);
    // a zero of either sign becomes the positive one, which has a short form
    let round = |value: &f64| (value / step).round() * step + 0.0;
    curve.iter().map(round).collect()
}

/// Serialises a curve in the compact wire format.
///
/// # Errors
/// Errors of the serializer.
pub fn serialize<S: Serializer>(curve: &[f64], to: S) -> Result<S::Ok, S::Error> {
    to.serialize_bytes(&form::encode(curve))
}

/// Deserialises a curve from the compact wire format.
///
/// # Errors
/// Errors of the deserializer, and bytes that are not an encoded curve.
pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
    let bytes = serde_bytes::ByteBuf::deserialize(from)?;
    form::decode(&bytes).map_err(de::Error::custom)
}

/// Wire format of a list of curves.
pub mod each {
    use super::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Deserialize)]
    #[serde(rename = "Curve")]
    struct Read(#[serde(with = "super")] Vec<f64>);

    #[derive(Serialize)]
    struct Written<'a>(#[serde(with = "super")] &'a [f64]);

    /// Serialises a list of curves in the compact wire format.
    ///
    /// # Errors
    /// Errors of the serializer.
    pub fn serialize<S: Serializer>(curves: &[Vec<f64>], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(curves.iter().map(|curve| Written(curve)))
    }

    /// Deserialises a list of curves from the compact wire format.
    ///
    /// # Errors
    /// Errors of the deserializer, and bytes that are not an encoded curve.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Vec<f64>>, D::Error> {
        let curves = Vec::<Read>::deserialize(from)?;
        Ok(curves.into_iter().map(|Read(curve)| curve).collect())
    }
}
