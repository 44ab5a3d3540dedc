//! Abscissa x channel: windows in which a residual cannot be noise.
//!
//! The residual's mean over windows of 5, 11 and 21 bins is held against the largest such mean, over
//! all windows and channels, of records with nothing but noise: so any false window at all appears in
//! a share of records that is set beforehand. Such records are the cycles themselves with signs
//! flipped: where only noise is left, a cycle's residual is as likely as its negative, whatever its
//! colour. Windows are measured in a scale that no flip changes. With too few cycles for that the
//! noise is drawn from the metric, which knows its variances less well than it believes.
use crate::place::along::null::{Null, can_flip};
use crate::place::along::windows::{WIDTHS, Windows, windows};
use crate::place::residual::Residual;
use crate::record::bins::Bins;
use nalgebra::DVector;

/// A window in which the residual is no noise.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Index of the channel.
    pub channel: usize,
    /// Where it begins, in the unit of the channel's abscissa.
    pub from: f64,
    /// Where it ends; beyond the end of a period where it runs on into the next.
    pub to: f64,
    /// Mean of the residual in it over its standard deviation.
    pub strength: f64,
    /// Probability that noise alone has any window so strong.
    pub p_value: f64,
}

/// The map: strength by channel and bin for the narrowest windows, and the significant windows, the
/// strongest of those that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct AlongMap {
    /// The bins of each channel's abscissa.
    pub bins: Vec<Bins>,
    /// By channel and first bin.
    pub strength: Vec<Vec<f64>>,
    /// Significant windows, the strongest first.
    pub windows: Vec<Window>,
}

/// Maps a whitened residual; `deviations` are those of the cycles from their mean, whitened and
/// projected likewise; at most `draws` sets of noise decide what is significant at `alpha`.
pub fn map(
    residual: &Residual<'_>,
    deviations: &[DVector<f64>],
    draws: usize,
    alpha: f64,
) -> AlongMap {
    let Residual {
        left,
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
    let mut found: Vec<Window> = places
        .map(|(channel, w, b)| {
            let strength = seen[channel][w][b] / null.scales[channel][w];
            Window {
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
    let mut kept: Vec<Window> = Vec::new();
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

fn overlap(a: &Window, b: &Window, bins: &Bins) -> bool {
    let turn = if bins.around {
        bins.width * bins.count as f64
    } else {
        0.0
    };
    [-turn, 0.0, turn]
        .iter()
        .any(|turn| a.from < b.to + turn && b.from + turn < a.to)
}
