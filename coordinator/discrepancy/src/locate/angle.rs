//! Crank angle x channel: windows of the revolution in which a residual cannot be noise.
//!
//! The residual's mean over windows of 5, 11 and 21 bins is held against the largest such mean, over
//! all windows and channels, of records with nothing but noise: so any false window at all appears in
//! a share of records that is set beforehand. Such records are the cycles themselves with signs
//! flipped: where only noise is left, a cycle's residual is as likely as its negative, whatever its
//! colour. Windows are measured in a scale that no flip changes. With too few cycles for that the
//! noise is drawn from the metric, which knows its variances less well than it believes.
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

/// Maps a whitened residual; `deviations` are those of the cycles from their mean, whitened and
/// projected likewise; at most `draws` sets of noise decide what is significant at `alpha`.
pub fn map(
    residual: &DVector<f64>,
    deviations: &[DVector<f64>],
    (metric, tangent): (&Metric, &Tangent),
    draws: usize,
    alpha: f64,
) -> AngleMap {
    let seen = windows(residual, metric);
    let null = if can_flip(deviations.len(), alpha) {
        let cycles: Vec<Windows> = deviations
            .iter()
            .map(|deviation| windows(&(residual + deviation), metric))
            .collect();
        Null::flipped(&cycles, draws)
    } else {
        Null::drawn(metric, tangent, draws)
    };
    let bin_deg = 360.0 / BINS as f64;
    let places = (0..metric.channels())
        .flat_map(|c| (0..WIDTHS.len()).flat_map(move |w| (0..BINS).map(move |b| (c, w, b))));
    let mut found: Vec<Window> = places
        .map(|(channel, w, b)| {
            let strength = seen[channel][w][b] / null.scales[channel][w];
            Window {
                channel,
                from_deg: b as f64 * bin_deg,
                to_deg: (b + WIDTHS[w]) as f64 * bin_deg,
                strength,
                p_value: null.p_value(strength),
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

/// Whether flips of so many cycles can tell one record in `1 / alpha`: the first cycle's sign is free.
fn can_flip(cycles: usize, alpha: f64) -> bool {
    cycles >= 2 && alpha * libm::exp2(cycles as f64 - 1.0) >= 1.0
}

/// What noise alone does to windows.
struct Null {
    /// Standard deviation by channel and width.
    scales: Vec<Vec<f64>>,
    /// The largest window of each set, in ascending order.
    maxima: Vec<f64>,
    /// Whether the record itself is one of the sets.
    complete: bool,
}

impl Null {
    /// From the cycles' windows, with signs flipped.
    fn flipped(cycles: &[Windows], draws: usize) -> Self {
        let n = cycles.len();
        let square = |c: usize, w: usize| -> f64 {
            let of = |cycle: &Windows| cycle[c][w].iter().map(|x| x * x).sum::<f64>();
            cycles.iter().map(of).sum::<f64>() / BINS as f64
        };
        let scale = |c: usize, w: usize| (square(c, w).sqrt() / n as f64).max(f64::MIN_POSITIVE);
        let scales: Vec<Vec<f64>> = (0..cycles[0].len())
            .map(|c| (0..WIDTHS.len()).map(|w| scale(c, w)).collect())
            .collect();
        let all = u32::try_from(n - 1)
            .ok()
            .and_then(|n| 1_usize.checked_shl(n));
        let complete = all.is_some_and(|all| all <= draws);
        let streams = Streams::new(0x666c_6970, 0);
        let sets = if complete {
            all.unwrap_or(draws)
        } else {
            draws
        };
        let signs = |set: usize| -> Vec<f64> {
            let mut stream = streams.at(0, Phase::Resample, set);
            let sign = |k: usize| {
                let minus = if complete {
                    k > 0 && set >> (k - 1) & 1 == 1
                } else {
                    stream.chance(0.5)
                };
                if minus { -1.0 } else { 1.0 }
            };
            (0..n).map(sign).collect()
        };
        let maxima = (0..sets).map(|set| {
            let signs = signs(set);
            let mean = |c: usize, w: usize, b: usize| {
                let parts = cycles
                    .iter()
                    .zip(&signs)
                    .map(|(cycle, sign)| sign * cycle[c][w][b]);
                parts.sum::<f64>() / n as f64
            };
            largest(&scales, mean)
        });
        Self::new(maxima.collect(), scales.clone(), complete)
    }

    /// From noise as the metric describes it.
    fn drawn(metric: &Metric, tangent: &Tangent, draws: usize) -> Self {
        let streams = Streams::new(0x616e_676c, 0);
        let noise: Vec<Windows> = (0..draws)
            .map(|draw| {
                let mut stream = streams.at(0, Phase::Resample, draw);
                let z = DVector::from_fn(metric.len(), |_, _| stream.normal());
                windows(&tangent.project(&z), metric)
            })
            .collect();
        let scale = |c: usize, w: usize| -> f64 {
            let of = |set: &Windows| set[c][w].iter().map(|x| x * x).sum::<f64>();
            let sum: f64 = noise.iter().map(of).sum();
            (sum / (draws * BINS) as f64).sqrt().max(f64::MIN_POSITIVE)
        };
        let scales: Vec<Vec<f64>> = (0..metric.channels())
            .map(|c| (0..WIDTHS.len()).map(|w| scale(c, w)).collect())
            .collect();
        let maxima = noise
            .iter()
            .map(|set| largest(&scales, |c, w, b| set[c][w][b]));
        Self::new(maxima.collect(), scales.clone(), false)
    }

    fn new(mut maxima: Vec<f64>, scales: Vec<Vec<f64>>, complete: bool) -> Self {
        maxima.sort_by(f64::total_cmp);
        Self {
            scales,
            maxima,
            complete,
        }
    }

    /// Share of sets with a window as strong.
    fn p_value(&self, strength: f64) -> f64 {
        // the record's own set has exactly its strongest window, up to rounding
        let below = self
            .maxima
            .partition_point(|m| *m < strength.abs() * (1.0 - 1e-9));
        let (above, sets) = (self.maxima.len() - below, self.maxima.len());
        if self.complete {
            above as f64 / sets as f64
        } else {
            (1 + above) as f64 / (1 + sets) as f64
        }
    }
}

/// The largest window over all channels, widths and bins.
fn largest(scales: &[Vec<f64>], value: impl Fn(usize, usize, usize) -> f64) -> f64 {
    let mut most: f64 = 0.0;
    for (c, scales) in scales.iter().enumerate() {
        for (w, scale) in scales.iter().enumerate() {
            for b in 0..BINS {
                most = most.max((value(c, w, b) / scale).abs());
            }
        }
    }
    most
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
