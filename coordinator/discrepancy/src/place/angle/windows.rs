//! Means of a whitened residual over windows of the revolution. What is significant it does not know.
use crate::record::metric::Metric;
use nalgebra::{Complex, DVector};

/// Bins of a revolution.
pub const BINS: usize = 120;
/// Widths of the windows (bins).
pub const WIDTHS: [usize; 3] = [5, 11, 21];

/// Means over windows, channel x width x first bin.
pub(crate) type Windows = Vec<Vec<Vec<f64>>>;

/// Window means of every channel's whitened curve.
pub(crate) fn windows(whitened: &DVector<f64>, metric: &Metric) -> Windows {
    (0..metric.channels())
        .map(|c| {
            let orders = 1..=metric.orders().highest();
            let of = |order| metric.coefficient(whitened, order, c);
            let spectrum: Vec<Complex<f64>> = orders.map(of).collect();
            let bins = bins(&spectrum);
            WIDTHS
                .iter()
                .map(|&width| moving_mean(&bins, width))
                .collect()
        })
        .collect()
}

/// The curve of a spectrum at the bins' centres, low orders only: a bin shows no more.
fn bins(spectrum: &[Complex<f64>]) -> Vec<f64> {
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

/// Mean over a window from each bin on, around the turn.
fn moving_mean(bins: &[f64], width: usize) -> Vec<f64> {
    let n = bins.len();
    let mut sum: f64 = bins.iter().take(width).sum();
    (0..n)
        .map(|b| {
            let mean = sum / width as f64;
            sum += bins[(b + width) % n] - bins[b];
            mean
        })
        .collect()
}
