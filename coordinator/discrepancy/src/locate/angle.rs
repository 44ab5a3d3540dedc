//! Crank angle x channel: windows of the revolution in which a residual cannot be noise.
//!
//! The residual's mean over windows of 5, 11 and 21 bins is held against the largest such mean, over
//! all windows and channels, of noise drawn from the metric and projected like the residual: so any
//! false window at all appears in a share of records that is set beforehand.
use crate::metric::Metric;
use crate::tangent::Tangent;
use nalgebra::{Complex, DVector};
use search::random::{Phase, Streams};

/// Bins of a revolution.
pub const BINS: usize = 120;
/// Widths of the windows (bins).
pub const WIDTHS: [usize; 3] = [5, 11, 21];

/// A window in which the residual is no noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Index of the channel.
    pub channel: usize,
    /// Where it begins (deg from bottom dead centre).
    pub from_deg: f64,
    /// Where it ends; may exceed 360 where it runs through bottom dead centre.
    pub to_deg: f64,
    /// Mean of the residual in it over its standard deviation.
    pub strength: f64,
    /// Family-wise p-value.
    pub p_value: f64,
}

/// The map: strength by channel and bin for the narrowest windows, and the significant windows, the
/// strongest of those that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleMap {
    /// Channel x bin.
    pub strength: Vec<Vec<f64>>,
    /// Significant windows, the strongest first.
    pub windows: Vec<Window>,
}

/// Statistics of windows, channel x width x first bin.
type Windows = Vec<Vec<Vec<f64>>>;

/// Maps a whitened residual; `draws` sets of noise decide what is significant at `alpha`.
pub fn map(
    residual: &DVector<f64>,
    metric: &Metric,
    tangent: &Tangent,
    draws: usize,
    alpha: f64,
) -> AngleMap {
    let streams = Streams::new(0x616e_676c, 0);
    let noise: Vec<Windows> = (0..draws)
        .map(|draw| {
            let mut stream = streams.at(0, Phase::Resample, draw);
            let z = DVector::from_fn(metric.len(), |_, _| stream.normal());
            windows(&tangent.project(&z), metric)
        })
        .collect();
    let seen = windows(residual, metric);
    let scale = |c: usize, w: usize, b: usize| -> f64 {
        let sum: f64 = noise.iter().map(|n| n[c][w][b] * n[c][w][b]).sum();
        (sum / draws as f64).sqrt().max(f64::MIN_POSITIVE)
    };
    let places: Vec<(usize, usize, usize)> = (0..metric.channels())
        .flat_map(|c| (0..WIDTHS.len()).flat_map(move |w| (0..BINS).map(move |b| (c, w, b))))
        .collect();
    let scales: Vec<f64> = places.iter().map(|&(c, w, b)| scale(c, w, b)).collect();
    let largest = |all: &Windows| -> f64 {
        let each = places.iter().zip(&scales);
        each.map(|(&(c, w, b), s)| (all[c][w][b] / s).abs())
            .fold(0.0, f64::max)
    };
    let mut maxima: Vec<f64> = noise.iter().map(largest).collect();
    maxima.sort_by(f64::total_cmp);
    let p_value = |strength: f64| -> f64 {
        let below = maxima.partition_point(|m| *m < strength.abs());
        (1 + draws - below) as f64 / (1 + draws) as f64
    };
    let bin_deg = 360.0 / BINS as f64;
    let mut found: Vec<Window> = places
        .iter()
        .zip(&scales)
        .map(|(&(channel, w, b), s)| {
            let strength = seen[channel][w][b] / s;
            Window {
                channel,
                from_deg: b as f64 * bin_deg,
                to_deg: (b + WIDTHS[w]) as f64 * bin_deg,
                strength,
                p_value: p_value(strength),
            }
        })
        .collect();
    let strength = (0..metric.channels())
        .map(|c| {
            let own = found.iter().filter(|f| f.channel == c);
            own.take(BINS).map(|f| f.strength).collect()
        })
        .collect();
    found.retain(|f| f.p_value <= alpha);
    found.sort_by(|a, b| b.strength.abs().total_cmp(&a.strength.abs()));
    let mut kept: Vec<Window> = Vec::new();
    for one in found {
        if !kept
            .iter()
            .any(|k| k.channel == one.channel && overlap(k, &one))
        {
            kept.push(one);
        }
    }
    AngleMap {
        strength,
        windows: kept,
    }
}

fn overlap(a: &Window, b: &Window) -> bool {
    [-360.0, 0.0, 360.0]
        .iter()
        .any(|turn| a.from_deg < b.to_deg + turn && b.from_deg + turn < a.to_deg)
}

/// Window means of every channel's whitened curve.
fn windows(whitened: &DVector<f64>, metric: &Metric) -> Windows {
    let channels = metric.channels();
    let highest = metric.orders().highest();
    (0..channels)
        .map(|c| {
            let spectrum: Vec<Complex<f64>> = (0..highest)
                .map(|k| {
                    let at = 2 * (k * channels + c);
                    Complex::new(whitened[at], whitened[at + 1])
                })
                .collect();
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
