//! Smooth discrepancy that a fit needs, as curves: what is missing beside the model, in the unit of each channel.
use crate::linear::whitened::WhitenedRecord;
use crate::model::fit::Fit;
use crate::validation::gap_closure::gap;
use nalgebra::{DMatrix, DVector};
use protocol::case::Channel;
use record::Curves;
use serde::{Deserialize, Serialize};

/// Half-width of a 95 % interval in standard deviations.
const WIDTH: f64 = 1.96;

/// Smooth discrepancy beside a fit, given its record and the fitted values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DiscrepancyEstimate {
    /// Channels of the fitted record, with the values of the abscissa that were fitted.
    pub channels: Vec<Channel>,
    /// Expected curve of each channel, in the channel's unit.
    pub mean: Curves,
    /// Half-width of the 95 % interval of each value, in the channel's unit.
    pub half: Curves,
    /// Correlation length, as a share of the abscissa's span.
    pub length: f64,
    /// Share of the record's gap without effects that the expected curve closes beside the fit.
    pub share: f64,
}

/// Estimates the discrepancy that a fit needs beside it; `before` is the gap of the record without effects. `None`
/// where the fit needs none.
pub(crate) fn discrepancy(
    record: &WhitenedRecord,
    fit: &Fit,
    before: f64,
) -> Option<DiscrepancyEstimate> {
    let found = fit.discrepancy()?;
    let waves = fit.smooth.as_ref()?.curves(found);
    // beside the fitted values, as the curves are drawn
    let columns = fit.waves();
    let information = columns.tr_mul(&columns) + DMatrix::identity(waves.len(), waves.len());
    let covariance = information.cholesky()?.inverse();
    let coefficients = &covariance * columns.tr_mul(&fit.search.best().residual);
    let lengths = fit.curves.iter().map(Vec::len);
    let mut mean: Curves = lengths.map(|n| vec![0.0; n]).collect();
    let mut half = mean.clone();
    for (c, (mean, half)) in mean.iter_mut().zip(&mut half).enumerate() {
        let own: Vec<usize> = (0..waves.len()).filter(|k| waves[*k].0 == c).collect();
        if own.is_empty() {
            continue;
        }
        let curves: Vec<DVector<f64>> = own.iter().map(|k| waves[*k].1.clone()).collect();
        let basis = DMatrix::from_columns(&curves);
        let expected = &basis * coefficients.select_rows(&own);
        let spread = &basis * covariance.select_rows(&own).select_columns(&own);
        for (i, (mean, half)) in mean.iter_mut().zip(half).enumerate() {
            *mean = expected[i];
            *half = WIDTH * spread.row(i).dot(&basis.row(i)).max(0.0).sqrt();
        }
    }
    let mut with = fit.curves.clone();
    let values = with.iter_mut().flatten().zip(mean.iter().flatten());
    values.for_each(|(y, by)| *y += by);
    let [left, taken] = [&fit.curves, &with].map(|curves| gap(&record.record, curves));
    let channels = record.record.channels.iter();
    Some(DiscrepancyEstimate {
        channels: channels.map(|own| own.channel.clone()).collect(),
        mean,
        half,
        length: found.length,
        share: (left.max(0.0) - taken.max(0.0)) / before.max(f64::MIN_POSITIVE),
    })
}
