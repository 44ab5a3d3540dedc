//! Map of a residual by abscissa and channel: windows in which the residual is larger than noise.
//!
//! Means of the residual over windows of 5, 11 and 21 bins are compared with the null distribution of the
//! largest window mean, over all windows and channels, of noise alone. The level is therefore family-wise:
//! the probability of any false window in a record. Noise records are the cycles themselves with random
//! signs: under noise alone a cycle's residual is as likely as its negative, whatever its autocorrelation.
//! Window means are scaled by a deviation that no sign flip changes. With too few cycles for sign flips the
//! noise is drawn from the metric, whose variances are then taken as known although they are estimates.
use crate::localisation::residual::Residual;
use crate::localisation::window_test::null::{Null, can_flip};
use crate::localisation::window_test::windows::{WIDTHS, Windows, windows};
use nalgebra::DVector;
use record::bins::Bins;
use serde::{Deserialize, Serialize};

/// Window of the abscissa in which the residual is significant.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AbscissaWindow {
    /// Index of the channel in the record.
    pub channel: usize,
    /// Start of the window on the channel's abscissa, in its unit.
    pub from: f64,
    /// End of the window on the channel's abscissa; beyond the end of the period if the window continues in
    /// the next period.
    pub to: f64,
    /// Strength of the window: mean of the residual over it, in standard deviations of that mean.
    pub strength: f64,
    /// Probability that noise alone has a window of at least this strength anywhere in the record.
    pub p_value: f64,
}

/// Map of the strength by channel and bin for the narrowest windows, with the significant windows; of
/// overlapping windows only the strongest is kept.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AlongMap {
    /// Bins into which each channel's abscissa is divided.
    pub bins: Vec<Bins>,
    /// Strength (window mean in standard deviations) of the narrowest windows, by channel and first bin.
    pub strength: Vec<Vec<f64>>,
    /// Significant windows, the strongest first.
    pub windows: Vec<AbscissaWindow>,
}

/// Maps a whitened residual. `deviations` are the deviations of the cycles from their mean, whitened and
/// projected likewise; the significance at level `alpha` is decided with at most `draws` sets of noise.
pub fn map(
    residual: &Residual<'_>,
    deviations: &[DVector<f64>],
    draws: usize,
    alpha: f64,
) -> AlongMap {
    let Residual {
        values: left,
        metric,
        tangent,
    } = *residual;
    let seen = windows(left, metric);
    let null = if can_flip(deviations.len(), alpha) {
        let cycles: Vec<Windows> = deviations
            .iter()
            .map(|deviation| windows(&(left + deviation), metric))
            .collect();
        Null::flipped(&cycles, draws)
    } else {
        Null::drawn(metric, tangent, draws)
    };
    let bins = metric.bins();
    let places = bins.iter().enumerate().flat_map(|(c, bins)| {
        let widths = WIDTHS.iter().enumerate();
        widths.flat_map(move |(w, width)| (0..bins.windows(*width)).map(move |b| (c, w, b)))
    });
    let mut found: Vec<AbscissaWindow> = places
        .map(|(channel, w, b)| {
            let strength = seen[channel][w][b] / null.scales[channel][w];
            AbscissaWindow {
                channel,
                from: bins[channel].begin(b),
                to: bins[channel].begin(b + WIDTHS[w]),
                strength,
                p_value: null.p_value(strength),
            }
        })
        .collect();
    let strength = (0..metric.channels())
        .map(|c| {
            let own = found.iter().filter(|f| f.channel == c);
            own.take(bins[c].windows(WIDTHS[0]))
                .map(|f| f.strength)
                .collect()
        })
        .collect();
    found.retain(|f| f.p_value <= alpha);
    found.sort_by(|a, b| b.strength.abs().total_cmp(&a.strength.abs()));
    let mut kept: Vec<AbscissaWindow> = Vec::new();
    for one in found {
        if !kept
            .iter()
            .any(|k| k.channel == one.channel && overlap(k, &one, &bins[one.channel]))
        {
            kept.push(one);
        }
    }
    AlongMap {
        bins,
        strength,
        windows: kept,
    }
}

fn overlap(a: &AbscissaWindow, b: &AbscissaWindow, bins: &Bins) -> bool {
    let turn = if bins.is_periodic {
        bins.width * bins.count as f64
    } else {
        0.0
    };
    [-turn, 0.0, turn]
        .iter()
        .any(|turn| a.from < b.to + turn && b.from + turn < a.to)
}
