//! Profile likelihoods of all unknowns, side by side: every look holds one unknown and refits all else.
//!
//! Where the quadratic picture holds, one simulation at the end that it has says so, and nothing is
//! refitted. It decides what to simulate; [`super::profile`] decides where.
use super::information::{inverse, with_priors};
use super::profile::{Next, RISE, Side};
use crate::laboratory::Laboratory;
use crate::linear::evidence::misfit;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use nalgebra::DMatrix;
use search::least_squares::{Settings, prior_cost};

/// How all else is refitted: it starts on the ridge.
const REFIT: Settings = Settings {
    iterations: 3,
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
    quadratic(experiments, &mut walked).await?;
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
        let sides = std::mem::take(&mut walked.sides);
        walked = begin(fit);
        for (new, old) in walked.sides.iter_mut().zip(sides) {
            *new = old.predicted(new.predicted);
        }
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

/// Looks where the quadratic has the ends, with all else where it has it.
async fn quadratic<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    walked: &mut Walked,
) -> Result<(), L::Error> {
    /// Farther away nothing is quadratic (coordinate).
    const FAR: f64 = 1.0;
    let mut places = Vec::new();
    let mut points = Vec::new();
    for (place, side) in walked.sides.iter().enumerate() {
        let at = walked.fit.x()[side.unknown] + side.sign * side.predicted;
        if side.predicted <= FAR && side.sign * (side.bound - at) > 0.0 {
            places.push(place);
            points.push(start(walked, side, at));
        }
    }
    let curves = experiments.curves(&points).await?;
    let least = walked.fit.search.cost();
    for ((place, point), curves) in places.into_iter().zip(points).zip(curves) {
        let Some(curves) = curves else { continue };
        let residual = experiments.on.residual(&curves);
        let cost = residual.norm_squared() + prior_cost(&point.x, walked.fit.variables());
        // a higher one only says that all else should have been refitted
        if cost - least <= (1.0 + 0.15) * walked.rise {
            let side = &mut walked.sides[place];
            side.absorb(point.x[side.unknown], Some((cost, point.x)));
        }
    }
    Ok(())
}

/// Looks and refits until every side has its end.
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
        let point = |(place, at): &(usize, f64)| {
            let side = &walked.sides[*place];
            let mut point = start(walked, side, *at);
            point.model.held = Some(side.unknown);
            point
        };
        let fits = experiments
            .fits(looks.iter().map(point).collect(), REFIT)
            .await?;
        for ((place, at), fit) in looks.into_iter().zip(fits) {
            let found = fit.map(|fit| (fit.search.cost(), fit.x().to_vec()));
            walked.sides[place].absorb(at, found);
        }
    }
}

/// Where a look starts: from the nearest point of the profile, along the quadratic's ridge.
fn start(walked: &Walked, side: &Side, at: f64) -> Point {
    let k = side.unknown;
    let x = walked.fit.x();
    let near = side.marks.iter().map(|mark| (mark.at, mark.x.as_slice()));
    let near = near.chain(std::iter::once((x[k], x)));
    let (from, x) = near
        .min_by(|a, b| (a.0 - at).abs().total_cmp(&(b.0 - at).abs()))
        .unwrap_or((x[k], x));
    let mut x = x.to_vec();
    if let Some(covariance) = &walked.covariance {
        let ridge = covariance.column(k) / covariance[(k, k)];
        for ((x, slope), v) in x.iter_mut().zip(ridge.iter()).zip(walked.fit.variables()) {
            *x = (*x + slope * (at - from)).clamp(v.lower, v.upper);
        }
    }
    x[k] = at;
    walked.fit.at(x)
}
