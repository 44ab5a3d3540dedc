//! The wire form of curves: about a byte for a sample where eight would stand.
//!
//! A curve whose values are whole multiples of a power of two, not too many of them, travels as those
//! multiples: the exponent, then differences of the multiples, which are small where a curve is
//! smooth. Whoever wants small messages therefore rounds curves ([`rounded`]) to a step far below
//! what they mean; whoever reads them needs no table of steps. Any other curve (a number that is not
//! finite, a negative zero, too wide a range) travels as doubles. Either way every bit comes back.
//!
//! ```text
//! | nothing                                                          an empty curve
//! | 255 | double ...                                                 as it is
//! | order u8 | width u8 | exponent i16 | samples u32 | code ...      multiples of 2^exponent
//! ```
//!
//! The code is Rice's: a difference, its sign in the lowest bit, is cut above its `width` lowest bits;
//! what is above stands as so many ones and a zero, then come the lowest bits. Of 24 ones the whole
//! difference follows.
//!
//! A field is given this form by `#[serde(with = "crate::curve")]`, several curves by
//! `#[serde(with = "crate::curve::each")]`.
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};

mod bits;
mod form;
#[cfg(test)]
mod tests;

/// A curve rounded to whole multiples of two to the `exponent`; numbers that are not finite stay.
pub fn rounded(curve: &[f64], exponent: i32) -> Vec<f64> {
    let step = form::power(exponent);
    // a zero of either sign becomes the positive one, which has a short form
    let round = |value: &f64| (value / step).round() * step + 0.0;
    curve.iter().map(round).collect()
}

/// Writes a curve.
///
/// # Errors
/// Of the serializer.
pub fn serialize<S: Serializer>(curve: &[f64], to: S) -> Result<S::Ok, S::Error> {
    to.serialize_bytes(&form::encode(curve))
}

/// Reads a curve.
///
/// # Errors
/// Of the deserializer, and for bytes that are no curve.
pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
    let bytes = serde_bytes::ByteBuf::deserialize(from)?;
    form::decode(&bytes).map_err(de::Error::custom)
}

/// The same for several curves.
pub mod each {
    use super::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Deserialize)]
    #[serde(rename = "Curve")]
    struct Read(#[serde(with = "super")] Vec<f64>);

    #[derive(Serialize)]
    struct Written<'a>(#[serde(with = "super")] &'a [f64]);

    /// Writes curves.
    ///
    /// # Errors
    /// Of the serializer.
    pub fn serialize<S: Serializer>(curves: &[Vec<f64>], to: S) -> Result<S::Ok, S::Error> {
        to.collect_seq(curves.iter().map(|curve| Written(curve)))
    }

    /// Reads curves.
    ///
    /// # Errors
    /// Of the deserializer, and for bytes that are no curve.
    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<Vec<f64>>, D::Error> {
        let curves = Vec::<Read>::deserialize(from)?;
        Ok(curves.into_iter().map(|Read(curve)| curve).collect())
    }
}
