//! Horizontal axis shared by several curves: range and title.
use super::scale::AxisScale;
use crate::{number::unit, words::abscissa_quantity};
use protocol::case::{Abscissa, Case};

/// Scale and title of a horizontal axis.
#[derive(Clone, Debug, PartialEq)]
pub struct ChartAxis {
    /// Range and ticks of the axis.
    pub scale: AxisScale,
    /// Quantity along the axis, with its unit.
    pub title: String,
}

impl ChartAxis {
    /// Creates the horizontal axis for an abscissa of a case.
    pub fn of(case: &Case, abscissa: &Abscissa) -> Self {
        let ends = abscissa.points.first().zip(abscissa.points.last());
        let (first, last) = ends.map_or((0.0, 1.0), |(first, last)| (*first, *last));
        let scale = match abscissa.period {
            Some(period) if abscissa.unit == "deg" && (period - 360.0).abs() < 1e-9 => {
                AxisScale::turn()
            }
            Some(period) => AxisScale::between(0.0, period, 6.0),
            None => AxisScale::between(first, last, 8.0),
        };
        Self {
            scale,
            title: format!(
                "{}{} [{}]",
                abscissa_quantity(abscissa),
                case::kind::of(case).abscissa_origin(),
                unit(&abscissa.unit)
            ),
        }
    }
}
