//! Waves of which the smooth discrepancy of a record is made, in units of the record's uncertainty.
use crate::linear::discrepancy::{SmoothBasis, Wave};
use nalgebra::{DMatrix, DVector};
use protocol::case::Abscissa;
use record::{Curves, Record};
use std::f64::consts::TAU;

/// Largest number of cycles of a wave over the span of its channel: model errors are smooth, and the spectrum
/// of the shortest length that is compared has fallen to a third there.
const HIGHEST: usize = 12;

/// Collects the waves of every channel of a record, with the constant of a channel with a fixed zero. `whiten` is the
/// linear map of curves into units of their uncertainty, `scales` the standard error of each channel's mean.
pub(crate) fn smooth_basis(
    record: &Record,
    scales: Vec<f64>,
    whiten: impl Fn(&Curves) -> DVector<f64>,
) -> SmoothBasis {
    let lengths = record
        .channels
        .iter()
        .map(|own| own.channel.abscissa.points.len());
    let nothing: Curves = lengths.map(|n| vec![0.0; n]).collect();
    let mut waves = Vec::new();
    let mut columns = Vec::new();
    for (channel, own) in record.channels.iter().enumerate() {
        let own = &own.channel;
        for (cycles, curve) in curves(&own.abscissa, own.is_absolute()) {
            let mut alone = nothing.clone();
            alone[channel].clone_from(&curve);
            let column = whiten(&alone);
            if column.norm() > 0.0 {
                columns.push(column);
                waves.push(Wave {
                    channel,
                    cycles,
                    curve,
                });
            }
        }
    }
    let rows = whiten(&nothing).len();
    let columns = if columns.is_empty() {
        DMatrix::zeros(rows, 0)
    } else {
        DMatrix::from_columns(&columns)
    };
    SmoothBasis::new(columns, waves, scales)
}

/// Returns waves along an abscissa, each with its number of cycles over the span: both phases of each order
/// of a period; without a period those of one that is longer than the span, so that the ends are independent of
/// each other; and the constant of an `absolute` curve.
pub(crate) fn curves(abscissa: &Abscissa, absolute: bool) -> Vec<(f64, Vec<f64>)> {
    /// Period of the waves of an abscissa that has none, in spans: the longest discrepancy that is compared is
    /// forgotten in half a span.
    const PERIOD: f64 = 1.5;
    let points = &abscissa.points;
    let (Some(first), Some(last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let (span, period, highest) = match abscissa.period {
        Some(period) => (period, period, HIGHEST),
        // 3 / 2 = PERIOD
        None => (last - first, PERIOD * (last - first), HIGHEST * 3 / 2),
    };
    let at = |order: usize, phase: fn(f64) -> f64| {
        let turns = TAU * order as f64 / period;
        let curve = points.iter().map(|t| phase(turns * (t - first)));
        (order as f64 * span / period, curve.collect())
    };
    let constant = absolute.then(|| at(0, libm::cos));
    let waves = (1..=highest).flat_map(|order| [at(order, libm::cos), at(order, libm::sin)]);
    constant.into_iter().chain(waves).collect()
}
