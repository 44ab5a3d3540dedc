//! The colours of the report: of lines and words, and scales of tension, pressure and deviation.
//!
//! Measured is black on a grey band, simulated is vermillion: the pair stays apart for colour-blind
//! readers and on a grey printer. The scales are even in lightness, and dark enough to stand on white
//! paper where they mean something.
use std::fmt;

/// A colour: red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Color(pub u8, pub u8, pub u8);

impl fmt::Display for Color {
    /// As CSS and SVG write it.
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "#{:02x}{:02x}{:02x}", self.0, self.1, self.2)
    }
}

/// Text and measured curves.
pub(crate) const INK: Color = Color(0x22, 0x22, 0x22);
/// Secondary text.
pub(crate) const GREY: Color = Color(0x6b, 0x6b, 0x6b);
/// Axes.
pub(crate) const AXIS: Color = Color(0x55, 0x55, 0x55);
/// Guide lines behind curves.
pub(crate) const GUIDE: Color = Color(0xe9, 0xe9, 0xe6);
/// The guide line at zero.
pub(crate) const ZERO: Color = Color(0xb9, 0xb9, 0xb5);
/// Bands of spread.
pub(crate) const BAND: Color = Color(0xd3, 0xd3, 0xd0);
/// Simulated curves and the optimum.
pub(crate) const VERMILLION: Color = Color(0xc8, 0x4b, 0x11);
/// Second simulated quantity.
pub(crate) const BLUE: Color = Color(0x0b, 0x5f, 0x9e);
/// Third simulated quantity.
pub(crate) const GREEN: Color = Color(0x1b, 0x7a, 0x5a);
/// Fourth simulated quantity.
pub(crate) const PURPLE: Color = Color(0x8a, 0x4f, 0x8f);

/// Tension, low to high: deep blue over violet and rose to orange.
const TENSION: [Color; 5] = [
    Color(0x1c, 0x2a, 0x7c),
    Color(0x5b, 0x1f, 0x9b),
    Color(0xa6, 0x2a, 0x8e),
    Color(0xdd, 0x51, 0x66),
    Color(0xf4, 0x92, 0x3a),
];

/// Pressure, none to high: paper over blue to ink.
const PRESSURE: [Color; 5] = [
    Color(0xf1, 0xf4, 0xf6),
    Color(0xb4, 0xcd, 0xde),
    Color(0x63, 0x9c, 0xc4),
    Color(0x22, 0x5f, 0x96),
    Color(0x08, 0x24, 0x4e),
];

/// Deviation, below to above: blue over paper to vermillion.
const SIGNED: [Color; 5] = [
    Color(0x0b, 0x4a, 0x7d),
    Color(0x7f, 0xb0, 0xd2),
    Color(0xf6, 0xf6, 0xf4),
    Color(0xea, 0xa1, 0x78),
    Color(0xb3, 0x3c, 0x08),
];

/// Colour of a deviation, as a share of the scale (-1 to 1, held inside).
pub(crate) fn signed(share: f64) -> Color {
    let share = if share.is_finite() { share } else { 0.0 };
    blend(&SIGNED, 0.5 + 0.5 * share)
}

/// Colour of a tension, as a share of the scale (0 to 1, held inside).
pub(crate) fn tension(share: f64) -> Color {
    blend(&TENSION, share)
}

/// Colour of a pressure, as a share of the scale (0 to 1, held inside).
pub(crate) fn pressure(share: f64) -> Color {
    blend(&PRESSURE, share)
}

/// The stops of the tension scale as CSS colours, evenly spaced.
pub(crate) fn tension_stops() -> Vec<String> {
    TENSION.iter().map(Color::to_string).collect()
}

fn blend(stops: &[Color; 5], share: f64) -> Color {
    let place = 4.0
        * if share.is_finite() {
            share.clamp(0.0, 1.0)
        } else {
            0.0
        };
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between 0 and 3"
    )]
    let below = place.floor().min(3.0) as usize;
    let (a, b) = (stops[below], stops[below + 1]);
    let share = place - below as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "between two bytes"
    )]
    let mix = |a: u8, b: u8| (f64::from(a) + share * (f64::from(b) - f64::from(a))).round() as u8;
    Color(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

#[cfg(test)]
mod tests {
    use super::{pressure, signed, tension};

    #[test]
    fn scales_end_at_their_stops_and_hold_outside() {
        assert_eq!(tension(0.0).to_string(), "#1c2a7c");
        assert_eq!(tension(7.0).to_string(), "#f4923a");
        assert_eq!(tension(f64::NAN).to_string(), "#1c2a7c");
        assert_eq!(pressure(0.5).to_string(), "#639cc4");
        assert_eq!(signed(0.0), signed(f64::NAN));
        assert_eq!(signed(-3.0).to_string(), "#0b4a7d");
    }
}
