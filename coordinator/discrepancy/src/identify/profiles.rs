//! Profile likelihoods of all unknowns, computed in parallel: each point holds one unknown and refits all
//! other variables.
//!
//! Where the quadratic approximation holds, simulations at its predicted end confirm it and no refit is
//! needed. This module runs the simulations; [`super::profile`] chooses the points.
use super::information::{inverse, with_priors};
use super::profile::{ProfileStep, Side};
use super::refit::{RefitRequest, refit};
use super::settings::FREE;
use crate::estimate::spread::Spread;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use nalgebra::DMatrix;
use record::metric::Metric;
use search::least_squares::LeastSquaresSettings;

/// Minimum amount by which a profile point must lie below the fit to count as a better fit, as a share of the
/// rise that ends a side.
const BETTER: f64 = 0.05;
/// Maximum number of times that all profiles are restarted from a better fit.
const AGAIN: usize = 2;

/// Best fit with the profile likelihoods of all its unknowns.
pub(super) struct Profiles {
    /// Best fit, from which the profiles start.
    pub(super) fit: Fit,
    /// Linearised uncertainty of the variables of the fit.
    pub(super) spread: Spread,
    /// Covariance of the fit's variables for a dispersion of one; `None` where it is singular.
    pub(super) covariance: Option<DMatrix<f64>>,
    /// Lower and upper side of the profile of each unknown.
    pub(super) sides: Vec<Side>,
    /// Rise of the cost that ends the interval of each unknown: the squared quantile of the interval, times
    /// the dispersion, times the variance inflation by the autocorrelation of the residual.
    pub(super) rises: Vec<f64>,
}

impl Profiles {
    /// Returns how and where a side of a profile ends (scaled coordinate).
    pub(super) fn end(&self, side: &Side) -> ProfileStep {
        let from = self.fit.x()[side.unknown];
        side.next(from, self.fit.search.cost(), self.rises[side.unknown])
    }

    /// Returns the lower and the upper side of an unknown's profile.
    pub(super) fn of(&self, unknown: usize) -> impl Iterator<Item = &Side> {
        self.sides
            .iter()
            .filter(move |side| side.unknown == unknown)
    }
}

/// Follows the profiles of all unknowns from a fit to their ends; `others` are fits in other minima.
pub(super) async fn walk<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: Fit,
    others: Vec<Fit>,
) -> Result<Profiles, L::Error> {
    let metric = &experiments.on.metric;
    let mut walked = begin(metric, fit, &others);
    follow(experiments, &mut walked).await?;
    for _ in 0..AGAIN {
        let cost = walked.fit.search.cost();
        let marks = walked.sides.iter().flat_map(|side| &side.marks);
        let least = marks.min_by(|a, b| a.cost.total_cmp(&b.cost));
        let Some(better) = least.filter(|mark| mark.cost < cost - BETTER * walked.spread.rise())
        else {
            break;
        };
        let start = walked.fit.at(better.x.clone());
        let Some(fit) = experiments.fit(start, FREE).await? else {
            break;
        };
        if fit.search.cost() >= cost {
            break;
        }
        // what was seen from another valley says too much is left
        walked = begin(&experiments.on.metric, fit, &others);
        follow(experiments, &mut walked).await?;
    }
    Ok(walked)
}

/// Creates the state before any profile point is computed; points known from other fits are included.
fn begin(metric: &Metric, fit: Fit, others: &[Fit]) -> Profiles {
    let spread = Spread::of(metric, &fit);
    let rises: Vec<f64> = spread
        .growth
        .iter()
        .map(|own| spread.rise() * own * own)
        .collect();
    let covariance = inverse(with_priors(&fit.search.best().jacobian, fit.variables()));
    let axes = fit.model.space.axes().iter().enumerate();
    let sides = axes.flat_map(|(k, axis)| {
        let predicted = spread.quantile * spread.variance(k).sqrt();
        let interval = axis.interval();
        [(-1.0, interval.from), (1.0, interval.to)]
            .map(|(sign, bound)| Side::new(k, sign, bound, predicted))
    });
    let mut walked = Profiles {
        sides: sides.collect(),
        covariance,
        spread,
        rises,
        fit,
    };
    let (x, least) = (walked.fit.x().to_vec(), walked.fit.search.cost());
    for other in others {
        let cost = other.search.cost();
        for side in &mut walked.sides {
            if cost - least < walked.rises[side.unknown] {
                side.add_known_point(x[side.unknown], cost, other.x());
            }
        }
    }
    walked
}

/// Refits from points at which poorly determined unknowns are reset to their recommended values, individually
/// and all together, to find other local minima that the record cannot distinguish. Returns the best fit, and
/// the others.
pub(super) async fn restarted<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: Fit,
) -> Result<(Fit, Vec<Fit>), L::Error> {
    /// Half-width of the 95 % interval above which an unknown counts as poorly determined (scaled
    /// coordinate).
    const HARDLY: f64 = 0.05;
    let sides = begin(&experiments.on.metric, fit.clone(), &[]).sides;
    let weak = sides.iter().filter(|side| side.sign > 0.0);
    let weak = weak.filter(|side| side.predicted > HARDLY);
    let weak: Vec<usize> = weak.map(|side| side.unknown).collect();
    let reset = |which: &[usize]| {
        let mut point = fit.point();
        for &k in which {
            point.x[k] = fit.model.space.axes()[k].interval().clamp(0.0);
        }
        point
    };
    let mut starts: Vec<Point> = weak.iter().map(|&k| reset(&[k])).collect();
    if weak.len() > 1 {
        starts.push(reset(&weak));
    }
    let settings = LeastSquaresSettings {
        iterations: 4,
        ..FREE
    };
    let fits = experiments.fits(starts, settings).await?;
    let mut all: Vec<Fit> = fits.into_iter().flatten().collect();
    all.push(fit.clone());
    all.sort_by(|a, b| b.search.cost().total_cmp(&a.search.cost()));
    let best = all.pop().unwrap_or(fit);
    Ok((best, all))
}

/// Computes profile points until every side has ended.
async fn follow<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    walked: &mut Profiles,
) -> Result<(), L::Error> {
    loop {
        let looks = walked.sides.iter().enumerate();
        let looks: Vec<(usize, f64)> = looks
            .filter_map(|(place, side)| match walked.end(side) {
                ProfileStep::Look(at) => Some((place, at)),
                ProfileStep::Over(..) => None,
            })
            .collect();
        if looks.is_empty() {
            return Ok(());
        }
        let starts = looks.iter().map(|(place, at)| {
            let side = &walked.sides[*place];
            starts(walked, side, *at)
        });
        let asked = RefitRequest {
            fit: &walked.fit,
            rises: &walked.rises,
        };
        let found = refit(experiments, &asked, starts.collect()).await?;
        for ((place, at), found) in looks.into_iter().zip(found) {
            walked.sides[place].add_result(at, found);
        }
    }
}

/// Returns the possible starts of a profile point's refit: the nearest computed point with only the held
/// unknown moved, the point along the ridge of the quadratic approximation, and the extrapolation of the two
/// nearest points.
fn starts(walked: &Profiles, side: &Side, at: f64) -> Vec<Point> {
    let k = side.unknown;
    let own = (walked.fit.x()[k], walked.fit.x());
    let marks = side.marks.iter().map(|mark| (mark.at, mark.x.as_slice()));
    let mut marks: Vec<(f64, &[f64])> = marks.chain(std::iter::once(own)).collect();
    marks.sort_by(|a, b| (a.0 - at).abs().total_cmp(&(b.0 - at).abs()));
    let (from, nearest) = marks[0];
    let along = |slopes: &[f64]| {
        let moved = nearest.iter().zip(slopes).zip(walked.fit.variables());
        let moved = moved.map(|((x, slope), v)| (x + slope * (at - from)).clamp(v.lower, v.upper));
        let mut x: Vec<f64> = moved.collect();
        x[k] = at;
        let mut point = walked.fit.at(x);
        point.model.fixed_unknown = Some(k);
        point
    };
    let mut all = vec![along(&vec![0.0; nearest.len()])];
    if let Some(covariance) = &walked.covariance {
        let ridge = covariance.column(k) / covariance[(k, k)];
        all.push(along(ridge.as_slice()));
    }
    if let Some((second, x)) = marks
        .get(1)
        .filter(|(second, _)| (second - from).abs() > 1e-9)
    {
        let pairs = nearest.iter().zip(*x);
        let slopes: Vec<f64> = pairs.map(|(a, b)| (a - b) / (from - second)).collect();
        all.push(along(&slopes));
    }
    all
}
