//! A record beside a fitted point, linear in the unknowns, with the scatter of its cycles.
use crate::record::measured::{Curves, Record};
use nalgebra::{DMatrix, DVector};

/// Fewer cycles than these have no scatter to speak of.
const CYCLES: usize = 3;

/// What is left of a record at the fitted point, cycle by cycle, and how the unknowns change it: grid
/// after grid of all channels, about their means (channels have no zero), in units of the cycles' scatter.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    /// Index of the record's condition.
    pub(crate) condition: usize,
    /// Of the mean of the cycles.
    pub(crate) left: DVector<f64>,
    /// Each cycle less their mean.
    pub(crate) deviations: Vec<DVector<f64>>,
    /// A column per unknown, per unit of it.
    pub(crate) columns: DMatrix<f64>,
    /// Samples of each channel.
    samples: Vec<usize>,
    /// Where the first channel's abscissa begins and ends, in its unit.
    pub(crate) span: [f64; 2],
}

impl Sheet {
    /// Whether a record has cycles enough.
    pub(crate) fn suits(record: &Record) -> bool {
        record.cycles.len() >= CYCLES
    }

    /// Of a record that suits, the curves at the fitted point, and the curves' change per unit of each
    /// unknown.
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

    /// Rows of the samples of one of so many equal parts, channel after channel.
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
