//! Profile likelihoods of all unknowns, side by side: every look holds one unknown and refits all else.
//!
//! Where the quadratic picture holds, simulations at the end that it has say so, and a refit finds nothing to
//! do. It decides what to simulate; [`super::profile`] decides where.
use super::information::{inverse, with_priors};
use super::profile::{Next, RISE, Side};
use crate::laboratory::Laboratory;
use crate::linear::evidence::misfit;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use crate::record::measured::Curves;
use nalgebra::DMatrix;
use search::least_squares::{Settings, prior_cost};

/// How all else is refitted: it starts on the ridge.
const REFIT: Settings = Settings {
    iterations: 4,
    gradient: 1e-2,
    decrease: 1e-3,
    change: 2.0,
    step_range: 10.0,
    level: 1e-3,
    central: false,
    exact: false,
};
/// A point that leaves less than the fit by this share of the wanted rise is a better fit.
const BETTER: f64 = 0.05;
/// How often a better fit is taken.
const AGAIN: usize = 2;

/// A fit with the profiles of its unknowns.
pub(super) struct Walked {
    /// The best fit.
    pub(super) fit: Fit,
    /// Covariance of its variables for a misfit of one.
    pub(super) covariance: Option<DMatrix<f64>>,
    /// Below and above, unknown by unknown.
    pub(super) sides: Vec<Side>,
    /// The rise that ends an interval: that of the quadratic times the squared misfit.
    pub(super) rise: f64,
}

impl Walked {
    /// How a side ends, and where (coordinate).
    pub(super) fn end(&self, side: &Side) -> Next {
        let from = self.fit.x()[side.unknown];
        side.next(from, self.fit.search.cost(), self.rise)
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
    let mut walked = begin(fit);
    for _ in 0..=AGAIN {
        follow(experiments, &mut walked).await?;
        let cost = walked.fit.search.cost();
        let marks = walked.sides.iter().flat_map(|side| &side.marks);
        let least = marks.min_by(|a, b| a.cost.total_cmp(&b.cost));
        let Some(better) = least.filter(|mark| mark.cost < cost - BETTER * walked.rise) else {
            break;
        };
        let start = walked.fit.at(better.x.clone());
        let settings = Settings {
            iterations: 10,
            ..REFIT
        };
        let Some(fit) = experiments.fit(start, settings).await? else {
            break;
        };
        if fit.search.cost() >= cost {
            break;
        }
        // what was seen from another valley says too much is left
        walked = begin(fit);
    }
    Ok(walked)
}

fn begin(fit: Fit) -> Walked {
    let phi = misfit(fit.chi_squared(), fit.entries());
    let rise = RISE * phi * phi;
    let covariance = inverse(with_priors(&fit.search.best().jacobian, fit.variables()));
    let axes = fit.model.space.axes().iter().enumerate();
    let sides = axes.flat_map(|(k, axis)| {
        let variance = covariance.as_ref().map_or(f64::INFINITY, |c| c[(k, k)]);
        let predicted = (rise * variance).sqrt();
        let interval = axis.interval();
        [(-1.0, interval.from), (1.0, interval.to)]
            .map(|(sign, bound)| Side::new(k, sign, bound, predicted))
    });
    Walked {
        sides: sides.collect(),
        covariance,
        rise,
        fit,
    }
}

/// Looks until every side has its end: where a start already leaves little it is not refitted, for a refit
/// leaves less still.
async fn follow<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    walked: &mut Walked,
) -> Result<(), L::Error> {
    /// So much of the wanted rise is little.
    const LITTLE: f64 = 0.85;
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
        let best = best_of(experiments, &walked.fit, starts.collect()).await?;
        let least = walked.fit.search.cost();
        let mut open = Vec::new();
        for ((place, at), best) in looks.into_iter().zip(best) {
            let side = &mut walked.sides[place];
            match best {
                None => side.absorb(at, None),
                Some((cost, point)) if cost - least <= LITTLE * walked.rise => {
                    side.absorb(at, Some((cost, point.x)));
                }
                Some((_, mut point)) => {
                    point.model.held = Some(side.unknown);
                    open.push((place, at, point));
                }
            }
        }
        let points = open.iter().map(|(.., point)| point.clone());
        let fits = experiments.fits(points.collect(), REFIT).await?;
        for ((place, at, _), fit) in open.into_iter().zip(fits) {
            let found = fit.map(|fit| (fit.search.cost(), fit.x().to_vec()));
            walked.sides[place].absorb(at, found);
        }
    }
}

/// Of each set of points the one that leaves least, with what it leaves; nothing where none completes.
async fn best_of<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    sets: Vec<Vec<Point>>,
) -> Result<Vec<Option<(f64, Point)>>, L::Error> {
    let curves = experiments.curves(&sets.concat()).await?;
    let mut curves = curves.into_iter();
    let best = |set: Vec<Point>| {
        let seen: Vec<Option<Curves>> = curves.by_ref().take(set.len()).collect();
        let left = |curves: &Curves, point: &Point| {
            let residual = experiments.on.residual(curves);
            residual.norm_squared() + prior_cost(&point.x, fit.variables())
        };
        let costs = set.into_iter().zip(seen);
        let costs = costs.filter_map(|(point, curves)| Some((left(&curves?, &point), point)));
        costs.min_by(|a, b| a.0.total_cmp(&b.0))
    };
    Ok(sets.into_iter().map(best).collect())
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
        walked.fit.at(x)
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
