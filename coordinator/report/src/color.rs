//! Colours of the report: lines, text, and colour scales of strength and deviation.
//!
//! Measured is black on a grey band, simulated is vermillion: the pair can be told apart by colour-blind
//! readers and in greyscale print. The scales are uniform in lightness, and dark enough for white paper at
//! significant values.
use std::fmt;

/// Colour with red, green and blue components.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(pub u8, pub u8, pub u8);

impl fmt::Display for Color {
    /// Writes the colour in the notation of CSS and SVG.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Colour of text and measured curves.
pub const INK: Color = Color(0x22, 0x22, 0x22);
/// Colour of secondary text.
pub const GREY: Color = Color(0x6b, 0x6b, 0x6b);
/// Colour of axes.
pub const AXIS: Color = Color(0x55, 0x55, 0x55);
/// Colour of guide lines behind curves.
pub const GUIDE: Color = Color(0xe9, 0xe9, 0xe6);
/// Colour of the guide line at zero.
pub const ZERO: Color = Color(0xb9, 0xb9, 0xb5);
/// Colour of bands of spread.
pub const BAND: Color = Color(0xd3, 0xd3, 0xd0);
/// Colour of simulated curves and the optimum.
pub const VERMILLION: Color = Color(0xc8, 0x4b, 0x11);
/// Colour of the second simulated quantity.
pub const BLUE: Color = Color(0x0b, 0x5f, 0x9e);
/// Colour of the third simulated quantity.
pub const GREEN: Color = Color(0x1b, 0x7a, 0x5a);
/// Colour of the fourth simulated quantity.
pub const PURPLE: Color = Color(0x8a, 0x4f, 0x8f);

/// Colour scale of five evenly spaced stops from the lowest to the highest value.
pub struct Ramp(pub [Color; 5]);

/// Colour scale of strength, from none to high: pale over blue to near black.
pub const STRENGTH: Ramp = Ramp([
    Color(0xf1, 0xf4, 0xf6),
    Color(0xb4, 0xcd, 0xde),
    Color(0x63, 0x9c, 0xc4),
    Color(0x22, 0x5f, 0x96),
    Color(0x08, 0x24, 0x4e),
]);

/// Colour scale of signed deviation: blue for negative, pale for none, vermillion for positive.
pub const SIGNED: Ramp = Ramp([
    Color(0x0b, 0x4a, 0x7d),
    Color(0x7f, 0xb0, 0xd2),
    Color(0xf6, 0xf6, 0xf4),
    Color(0xea, 0xa1, 0x78),
    Color(0xb3, 0x3c, 0x08),
]);

impl Ramp {
    /// Returns the colour at a position on the colour scale, clamped to 0 to 1; the lowest colour if the
    /// position is not finite.
    pub fn at(&self, share: f64) -> Color {
        let share = if share.is_finite() { share } else { 0.0 };
        let place = 4.0 * share.clamp(0.0, 1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 0 and 3"
        )]
        let below = place.floor().min(3.0) as usize;
        let (a, b) = (self.0[below], self.0[below + 1]);
        let share = place - below as f64;
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between two bytes"
        )]
        let mix =
            |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
        Color(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
    }
}

#[cfg(test)]
mod tests {
    use super::{SIGNED, STRENGTH};

    #[test]
    fn scales_end_at_their_stops_and_hold_outside() {
        assert_eq!(STRENGTH.at(0.0).to_string(), "#f1f4f6");
        assert_eq!(STRENGTH.at(7.0).to_string(), "#08244e");
        assert_eq!(STRENGTH.at(f64::NAN).to_string(), "#f1f4f6");
        assert_eq!(STRENGTH.at(0.5).to_string(), "#639cc4");
        assert_eq!(SIGNED.at(-1.0).to_string(), "#0b4a7d");
    }
}
