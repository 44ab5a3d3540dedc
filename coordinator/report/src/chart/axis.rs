//! The horizontal axis that curves share: how far it goes, and what is counted along it.
use super::scale::Scale;
use crate::number::unit;
use crate::words::counted;
use protocol::case::Abscissa;

/// Scale and title of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// From where to where.
    pub scale: Scale,
    /// What is counted, with its unit.
    pub title: String,
}

impl Axis {
    /// The axis of a channel; `zero` says behind the name where it begins, and may be empty.
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
