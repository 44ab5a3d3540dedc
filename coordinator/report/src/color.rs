//! The colours of the report: of lines and words, and scales of strength and deviation.
//!
//! Measured is black on a grey band, simulated is vermillion: the pair stays apart for colour-blind
//! readers and on a grey printer. The scales are even in lightness, and dark enough to stand on white
//! paper where they mean something.
use std::fmt;

/// A colour: red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Color(pub u8, pub u8, pub u8);

impl fmt::Display for Color {
    /// As CSS and SVG write it.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Text and measured curves.
pub const INK: Color = Color(0x22, 0x22, 0x22);
/// Secondary text.
pub const GREY: Color = Color(0x6b, 0x6b, 0x6b);
/// Axes.
pub const AXIS: Color = Color(0x55, 0x55, 0x55);
/// Guide lines behind curves.
pub const GUIDE: Color = Color(0xe9, 0xe9, 0xe6);
/// The guide line at zero.
pub const ZERO: Color = Color(0xb9, 0xb9, 0xb5);
/// Bands of spread.
pub const BAND: Color = Color(0xd3, 0xd3, 0xd0);
/// Simulated curves and the optimum.
pub const VERMILLION: Color = Color(0xc8, 0x4b, 0x11);
/// Second simulated quantity.
pub const BLUE: Color = Color(0x0b, 0x5f, 0x9e);
/// Third simulated quantity.
pub const GREEN: Color = Color(0x1b, 0x7a, 0x5a);
/// Fourth simulated quantity.
pub const PURPLE: Color = Color(0x8a, 0x4f, 0x8f);

/// A scale of colours, evenly spaced from its lowest value to its highest.
pub struct Ramp(pub [Color; 5]);

/// Strength, none to high: paper over blue to ink.
pub const STRENGTH: Ramp = Ramp([
    Color(0xf1, 0xf4, 0xf6),
    Color(0xb4, 0xcd, 0xde),
    Color(0x63, 0x9c, 0xc4),
    Color(0x22, 0x5f, 0x96),
    Color(0x08, 0x24, 0x4e),
]);

/// Deviation, below to above: blue over paper to vermillion; its middle is none.
pub const SIGNED: Ramp = Ramp([
    Color(0x0b, 0x4a, 0x7d),
    Color(0x7f, 0xb0, 0xd2),
    Color(0xf6, 0xf6, 0xf4),
    Color(0xea, 0xa1, 0x78),
    Color(0xb3, 0x3c, 0x08),
]);

impl Ramp {
    /// The colour at a share of the scale: 0 to 1, held inside; the lowest for what is no number.
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
