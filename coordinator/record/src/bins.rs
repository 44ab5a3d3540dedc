//! Equal bins of an abscissa, and the values of a whitened curve in them.
use crate::basis::{Basis, ChannelGroup};
use nalgebra::Complex;
use serde::{Deserialize, Serialize};

/// Maximum number of bins into which an abscissa is divided.
pub const BINS: usize = 120;

/// Division of an abscissa into equal bins.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bins {
    /// Start of the first bin, in the abscissa's unit.
    pub from: f64,
    /// Width of a bin, in the abscissa's unit.
    pub width: f64,
    /// Number of bins.
    pub count: usize,
    /// Whether the abscissa is periodic, so that the first bin follows the last.
    pub is_periodic: bool,
}

impl Bins {
    /// Divides the abscissa of a channel group into bins, at most as many as there are samples.
    pub fn of(group: &ChannelGroup) -> Self {
        let points = &group.abscissa.points;
        let from = points.first().copied().unwrap_or_default();
        let around = group.is_periodic();
        let span = points.last().map_or(0.0, |last| last - from);
        let span = group.abscissa.period.filter(|_| around).unwrap_or(span);
        let count = if around {
            BINS
        } else {
            BINS.min(group.basis.places())
        };
        Self {
            from,
            width: span / count.max(1) as f64,
            count,
            is_periodic: around,
        }
    }

    /// Returns the start of a bin, in the abscissa's unit.
    pub fn begin(&self, bin: usize) -> f64 {
        self.from + bin as f64 * self.width
    }

    /// Returns the number of windows of `width` bins; 0 if the abscissa is shorter.
    pub const fn windows(&self, width: usize) -> usize {
        match (self.is_periodic, self.count < width) {
            (_, true) => 0,
            (true, _) => self.count,
            (false, _) => self.count + 1 - width,
        }
    }

    /// Returns the mean of the values in each window of `width` bins, indexed by the window's first bin.
    pub fn moving_mean(&self, values: &[f64], width: usize) -> Vec<f64> {
        let n = values.len();
        let mut sum: f64 = values.iter().take(width).sum();
        (0..self.windows(width))
            .map(|b| {
                let mean = sum / width as f64;
                sum += values[(b + width) % n] - values[b];
                mean
            })
            .collect()
    }
}

/// Returns a channel's whitened basis coefficients as values along the abscissa, one per bin; `row` is the
/// index of the channel in its group.
pub fn along(group: &ChannelGroup, row: usize, entries: &[Complex<f64>]) -> Vec<f64> {
    match &group.basis {
        Basis::Orders(_) => turn(entries),
        Basis::Samples(samples) => {
            let entries = samples[row].by_sample(entries);
            let bins = Bins::of(group);
            let (mut sums, mut counts) = (vec![0.0; bins.count], vec![0.0; bins.count]);
            // a sample's entry says what it adds to the one before: the first has none where constants do not count
            let points = &group.abscissa.points;
            let left_out = points.len().saturating_sub(entries.len());
            for (entry, x) in entries.iter().zip(points.iter().skip(left_out)) {
                let ahead = ((x - bins.from) / bins.width.max(f64::MIN_POSITIVE)).max(0.0);
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "not negative, and cut at the last bin"
                )]
                let bin = (ahead as usize).min(bins.count - 1);
                sums[bin] += entry;
                counts[bin] += 1.0;
            }
            let each = sums.iter().zip(&counts);
            each.map(|(sum, count): (&f64, &f64)| sum / count.max(1.0).sqrt())
                .collect()
        }
    }
}

/// Returns the curve with given Fourier coefficients at the centres of the bins, using orders below half the
/// number of bins.
fn turn(spectrum: &[Complex<f64>]) -> Vec<f64> {
    let turn = std::f64::consts::TAU / (2 * BINS) as f64;
    let table: Vec<(f64, f64)> = (0..2 * BINS)
        .map(|i| libm::sincos(turn * i as f64))
        .collect();
    (0..BINS)
        .map(|b| {
            let orders = spectrum.iter().take(BINS / 2).enumerate();
            orders
                .map(|(k, f)| {
                    let (sine, cosine) = table[(k + 1) * (2 * b + 1) % (2 * BINS)];
                    f.re * cosine - f.im * sine
                })
                .sum()
        })
        .collect()
}
