//! The colour scales of the report: rope tension, contact pressure, and signed deviation.
//!
//! All are even in lightness and readable by colour-blind readers, and dark enough everywhere to
//! stand on white paper where they mean something.
use plotters::prelude::RGBColor;

/// Tension, low to high: deep blue over violet and rose to orange.
const TENSION: [(u8, u8, u8); 5] = [
    (0x1c, 0x2a, 0x7c),
    (0x5b, 0x1f, 0x9b),
    (0xa6, 0x2a, 0x8e),
    (0xdd, 0x51, 0x66),
    (0xf4, 0x92, 0x3a),
];

/// Pressure, none to high: paper over blue to ink.
const PRESSURE: [(u8, u8, u8); 5] = [
    (0xf1, 0xf4, 0xf6),
    (0xb4, 0xcd, 0xde),
    (0x63, 0x9c, 0xc4),
    (0x22, 0x5f, 0x96),
    (0x08, 0x24, 0x4e),
];

/// Deviation, below to above: blue over paper to vermillion.
const SIGNED: [(u8, u8, u8); 5] = [
    (0x0b, 0x4a, 0x7d),
    (0x7f, 0xb0, 0xd2),
    (0xf6, 0xf6, 0xf4),
    (0xea, 0xa1, 0x78),
    (0xb3, 0x3c, 0x08),
];

/// Colour of a deviation, as a share of the scale (-1 to 1, held inside).
pub(super) fn signed(share: f64) -> RGBColor {
    let share = if share.is_finite() { share } else { 0.0 };
    blend(&SIGNED, 0.5 + 0.5 * share)
}

/// Colour of a tension, as a share of the scale (0 to 1, held inside).
pub(super) fn tension(share: f64) -> RGBColor {
    blend(&TENSION, share)
}

/// Colour of a pressure, as a share of the scale (0 to 1, held inside).
pub(super) fn pressure(share: f64) -> RGBColor {
    blend(&PRESSURE, share)
}

/// As CSS writes it.
pub(super) fn css(color: RGBColor) -> String {
    format!("#{:02x}{:02x}{:02x}", color.0, color.1, color.2)
}

/// The stops of the tension scale as CSS colours, evenly spaced.
pub(super) fn tension_stops() -> Vec<String> {
    TENSION
        .iter()
        .map(|&(r, g, b)| css(RGBColor(r, g, b)))
        .collect()
}

fn blend(stops: &[(u8, u8, u8); 5], share: f64) -> RGBColor {
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
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

#[cfg(test)]
mod tests {
    use super::{css, pressure, signed, tension};

    #[test]
    fn scales_end_at_their_stops_and_hold_outside() {
        assert_eq!(css(tension(0.0)), "#1c2a7c");
        assert_eq!(css(tension(7.0)), "#f4923a");
        assert_eq!(css(tension(f64::NAN)), "#1c2a7c");
        assert_eq!(css(pressure(0.5)), "#639cc4");
        assert_eq!(css(signed(0.0)), css(signed(f64::NAN)));
        assert_eq!(css(signed(-3.0)), "#0b4a7d");
    }
}
