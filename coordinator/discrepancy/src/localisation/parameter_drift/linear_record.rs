//! Record linearised about a fitted point, with the scatter of its cycles.
use nalgebra::{DMatrix, DVector};
use record::{Curves, Record};

/// Smallest number of cycles from which a scatter is estimated.
const CYCLES: usize = 3;

/// Residual of a record at the fitted point, cycle by cycle, and its derivatives by the unknowns. Channels
/// are concatenated, taken about their means (channels have no zero) and divided by the scatter of the
/// cycles.
#[derive(Clone, Debug)]
pub(crate) struct LinearizedRecord {
    /// Index of the working condition under which the record was measured.
    pub(crate) condition: usize,
    /// Residual of the mean of the cycles, measured less simulated, in units of the cycles' scatter.
    pub(crate) left: DVector<f64>,
    /// Deviation of each cycle from the mean over the cycles, in units of the scatter between cycles.
    pub(crate) deviations: Vec<DVector<f64>>,
    /// Derivatives of the simulated curves, one matrix column per unknown.
    pub(crate) columns: DMatrix<f64>,
    samples: Vec<usize>,
    /// Start and end of the first channel's abscissa, in its unit.
    pub(crate) span: [f64; 2],
}

impl LinearizedRecord {
    /// Returns whether a record has enough cycles to estimate the scatter between them.
    pub(crate) fn suits(record: &Record) -> bool {
        record.cycles.len() >= CYCLES
    }

    /// Linearises a record, from the curves at the fitted point and their derivatives by each unknown; the
    /// record must have enough cycles to estimate their scatter.
    pub(crate) fn new(record: &Record, fitted: &Curves, changes: &[Curves]) -> Self {
        let variance = record.cycle_variance();
        let flat = |curves: &Curves| {
            let channels = curves.iter().zip(&variance);
            let scaled = channels.flat_map(|(curve, variance)| {
                let mean = curve.iter().sum::<f64>() / curve.len().max(1) as f64;
                // a channel without scatter was not measured
                let weight = if *variance > 0.0 {
                    variance.sqrt().recip()
                } else {
                    0.0
                };
                curve.iter().map(move |y| weight * (y - mean))
            });
            DVector::from_iterator(curves.iter().map(Vec::len).sum(), scaled)
        };
        let mean = flat(&record.mean());
        let columns: Vec<DVector<f64>> = changes.iter().map(flat).collect();
        Self {
            condition: record.condition,
            left: &mean - flat(fitted),
            deviations: record.cycles.iter().map(|c| flat(c) - &mean).collect(),
            columns: DMatrix::from_columns(&columns),
            samples: fitted.iter().map(Vec::len).collect(),
            span: record.span(),
        }
    }

    /// Returns the indices of all channels' samples that lie in part `part` (from 0) of `of` equal parts of
    /// the abscissa.
    pub(crate) fn rows(&self, part: usize, of: usize) -> Vec<usize> {
        let mut begin = 0;
        let mut rows = Vec::new();
        for samples in &self.samples {
            let end = |k: usize| begin + k * samples / of;
            rows.extend(end(part)..end(part + 1));
            begin += samples;
        }
        rows
    }
}
