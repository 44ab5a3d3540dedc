//! Crank angle x channel: windows of the revolution in which a residual cannot be noise.
//!
//! The residual's mean over windows of 5, 11 and 21 bins is held against the largest such mean, over
//! all windows and channels, of records with nothing but noise: so any false window at all appears in
//! a share of records that is set beforehand. Such records are the cycles themselves with signs
//! flipped: where only noise is left, a cycle's residual is as likely as its negative, whatever its
//! colour. Windows are measured in a scale that no flip changes. With too few cycles for that the
//! noise is drawn from the metric, which knows its variances less well than it believes.
use crate::place::angle::null::{Null, can_flip};
use crate::place::angle::windows::{BINS, WIDTHS, Windows, windows};
use crate::place::residual::Residual;
use nalgebra::DVector;

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
    /// Probability that noise alone has any window so strong.
    pub p_value: f64,
}

/// The map: strength by channel and bin for the narrowest windows, and the significant windows, the
/// strongest of those that overlap.
#[derive(Clone, Debug, PartialEq)]
pub struct AngleMap {
    /// By channel and bin.
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
) -> AngleMap {
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

fn overlap(a: &Window, b: &Window) -> bool {
    [-360.0, 0.0, 360.0]
        .iter()
        .any(|turn| a.from_deg < b.to_deg + turn && b.from_deg + turn < a.to_deg)
}
