//! Horizontal axis shared by several curves: range and title.
use super::scale::Scale;
use crate::number::unit;
use crate::words::counted;
use protocol::case::Abscissa;

/// Scale and title of a horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Range and ticks.
    pub scale: Scale,
    /// Quantity along the axis, with its unit.
    pub title: String,
}

impl Axis {
    /// Creates the axis of a channel; `zero`, appended to the name, states the origin of the abscissa and may
    /// be empty.
    pub fn of(abscissa: &Abscissa, zero: &str) -> Self {
        let ends = abscissa.points.first().zip(abscissa.points.last());
        let (first, last) = ends.map_or((0.0, 1.0), |(first, last)| (*first, *last));
        let scale = match abscissa.period {
            Some(period) if abscissa.unit == "deg" && (period - 360.0).abs() < 1e-9 => {
                Scale::turn()
            }
            Some(period) => Scale::between(0.0, period, 6.0),
            None => Scale::between(first, last, 8.0),
        };
        Self {
            scale,
            title: format!("{}{zero} [{}]", counted(abscissa), unit(&abscissa.unit)),
        }
    }
}
