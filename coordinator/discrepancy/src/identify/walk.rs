//! Profile likelihoods of all unknowns, side by side: every look holds one unknown and refits all else.
//!
//! Where the quadratic picture holds, simulations at the end that it has say so, and a refit finds nothing to
//! do. It decides what to simulate; [`super::profile`] decides where.
use super::information::{inverse, with_priors};
use super::profile::{Next, Side};
use super::refit::{Asked, refit};
use super::settings::FREE;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use crate::record::metric::Metric;
use crate::size::spread::Spread;
use nalgebra::DMatrix;
use search::least_squares::Settings;

/// A point that leaves less than the fit by this share of the wanted rise is a better fit.
const BETTER: f64 = 0.05;
/// How often a better fit is taken.
const AGAIN: usize = 2;

/// A fit with the profiles of its unknowns.
pub(super) struct Walked {
    /// The best fit.
    pub(super) fit: Fit,
    /// How far the record leaves its variables open, to first order.
    pub(super) spread: Spread,
    /// Covariance of its variables for a dispersion of one.
    pub(super) covariance: Option<DMatrix<f64>>,
    /// Below and above, unknown by unknown.
    pub(super) sides: Vec<Side>,
    /// The rise that ends an interval, unknown by unknown: the square of the interval's quantile, times the dispersion,
    /// times the variance that the colour of the residual costs.
    pub(super) rises: Vec<f64>,
}

impl Walked {
    /// How a side ends, and where (coordinate).
    pub(super) fn end(&self, side: &Side) -> Next {
        let from = self.fit.x()[side.unknown];
        side.next(from, self.fit.search.cost(), self.rises[side.unknown])
    }

    /// The sides of an unknown.
    pub(super) fn of(&self, unknown: usize) -> impl Iterator<Item = &Side> {
        self.sides
            .iter()
            .filter(move |side| side.unknown == unknown)
    }
}

/// Follows all profiles from a fit to their ends.
pub(super) async fn walk<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: Fit,
) -> Result<Walked, L::Error> {
    let mut others = restarted(experiments, fit.clone()).await?;
    let fit = others.pop().unwrap_or(fit);
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

/// A fit with all its profiles still to follow, but for what other fits say of them.
fn begin(metric: &Metric, fit: Fit, others: &[Fit]) -> Walked {
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
    let mut walked = Walked {
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
                side.know(x[side.unknown], cost, other.x());
            }
        }
    }
    walked
}

/// Fits from where unknowns that are hardly seen have their recommended values, each alone and all of them: a
/// record that does not part two valleys sees what lies between them no better. The best one is the last.
async fn restarted<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: Fit,
) -> Result<Vec<Fit>, L::Error> {
    /// Half width of an interval from which an unknown is hardly seen (coordinate).
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
    let settings = Settings {
        iterations: 4,
        ..FREE
    };
    let fits = experiments.fits(starts, settings).await?;
    let mut all: Vec<Fit> = fits.into_iter().flatten().collect();
    all.push(fit);
    all.sort_by(|a, b| b.search.cost().total_cmp(&a.search.cost()));
    Ok(all)
}

/// Looks until every side has its end.
async fn follow<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    walked: &mut Walked,
) -> Result<(), L::Error> {
    loop {
        let looks = walked.sides.iter().enumerate();
        let looks: Vec<(usize, f64)> = looks
            .filter_map(|(place, side)| match walked.end(side) {
                Next::Look(at) => Some((place, at)),
                Next::Over(..) => None,
            })
            .collect();
        if looks.is_empty() {
            return Ok(());
        }
        let starts = looks.iter().map(|(place, at)| {
            let side = &walked.sides[*place];
            starts(walked, side, *at)
        });
        let asked = Asked {
            fit: &walked.fit,
            rises: &walked.rises,
        };
        let found = refit(experiments, &asked, starts.collect()).await?;
        for ((place, at), found) in looks.into_iter().zip(found) {
            walked.sides[place].absorb(at, found);
        }
    }
}

/// Where a look may start: from the nearest point of the profile as it is, along the quadratic's ridge, and
/// along the line through the last two.
fn starts(walked: &Walked, side: &Side, at: f64) -> Vec<Point> {
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
        point.model.held = Some(k);
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
