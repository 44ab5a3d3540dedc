//! A record beside a fitted point, linear in the unknowns, with the scatter of its cycles.
use crate::record::measured::{Curves, Record};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Fewer cycles than these have no scatter to speak of.
const CYCLES: usize = 3;

/// What is left of a record at the fitted point, cycle by cycle, and how the unknowns change it: grid
/// after grid of all channels, about their means (gauges have no zero), in units of the cycles' scatter.
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
    /// Samples of a turn.
    samples: usize,
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
            samples: record.samples(),
        }
    }

    /// Rows of the samples of one of so many equal parts of the turn, channel after channel.
    pub(crate) fn rows(&self, part: usize, of: usize) -> Vec<usize> {
        let end = |k: usize| k * self.samples / of;
        let own: Range<usize> = end(part)..end(part + 1);
        let channels = (0..self.left.len()).step_by(self.samples.max(1));
        channels
            .flat_map(|c| own.clone().map(move |i| c + i))
            .collect()
    }
}
