//! Individuals about a fit, by which any quantity of the machine has an interval.
//!
//! An interval is to first order: the gradient of the quantity, by differences along each parameter, with the covariance
//! of the fit. Individuals drawn from the covariance check it. Along directions that the record hardly determines the
//! covariance reaches far beyond what is linear; there a draw is shortened until the misfit rises by no more than for the
//! whole draw to first order.
use crate::estimate::spread::Spread;
use crate::laboratory::Laboratory;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use crate::thresholds::NOISE_RATIO_LIMIT;
use nalgebra::{DMatrix, DVector};
use protocol::job::Individual;
use search::least_squares::prior_cost;
use search::random::{Phase, Streams};
use serde::{Deserialize, Serialize};

/// Number of individuals that are drawn from the covariance: an interval that holds 95 % of a quantity's values misses
/// more than four of them in one of 400 cases.
const DRAWN: usize = 20;

/// Standard deviation of a direction of the covariance, in coordinates of the fit, from which a draw along it is shortened
/// where the record excludes it: half a decade, a quarter of the interval of an unknown on a linear scale, or half of the
/// tolerance of an instrument.
const UNDETERMINED: f64 = 0.5;
/// Shares of the whole length that are tried one after the other.
const SHARES: [f64; 6] = [1.0, 0.5, 0.25, 0.125, 0.0625, 0.0];
/// Largest rise of the misfit at a draw, as a multiple of the rise for the whole draw to first order.
const RISE: f64 = 1.5;

/// Individuals about a fit: a pair along each parameter, by which a quantity is differentiated, and draws from the
/// covariance, by which its interval is checked. Errors of the instruments are none of their parameters, but add to the
/// covariance where the fit has them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Neighbourhood {
    /// Individuals below and above along the first parameter, then the second, and so on, then those drawn; 2 n + 20
    /// for n parameters: the searched unknowns, then those of each effect that the fit adds to the case. None are drawn
    /// where the budget of the stage is used up.
    pub individuals: Vec<Individual>,
    /// Distance between the two individuals of each pair, in coordinates of the fit; length n.
    distances: Vec<f64>,
    /// Covariance of the parameters in coordinates of the fit; n x n.
    covariance: DMatrix<f64>,
    /// Half-width of a 95 % interval in standard deviations.
    quantile: f64,
}

/// Reason why quantities have no intervals about a fit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum NoNeighbourhood {
    /// The record does not determine all parameters to first order.
    Undetermined,
    /// The fit leaves so much more than noise, and no smooth discrepancy stands for it, that its numbers are not those of
    /// the machine: the ratio of its residual to the noise.
    Misfit(f64),
}

/// 95 % interval of a quantity to first order, checked by drawn individuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantityInterval {
    /// Half-width of the interval, in the quantity's unit.
    pub half_width: f64,
    /// Number of drawn individuals with a value.
    pub drawn: usize,
    /// Number of them whose value lies in the interval.
    pub inside: usize,
}

impl QuantityInterval {
    /// Returns a remark if so few of the drawn individuals lie in the interval that the quantity is not linear over it.
    pub fn doubt(&self) -> Option<String> {
        (5 * self.inside < 4 * self.drawn).then(|| {
            format!(
                "of {} machines drawn from the covariance of the unknowns, {} lie in a 95 % interval: it is to first order, \
                 and too narrow here",
                self.drawn, self.inside
            )
        })
    }
}

impl Neighbourhood {
    /// Collects the individuals about a fit, or returns the reason why it has none. Simulates the draws that it may have
    /// to shorten.
    ///
    /// # Errors
    /// Those of the laboratory.
    pub(crate) async fn around<L: Laboratory>(
        experiments: &mut Experiments<'_, L>,
        fit: &Fit,
        spread: &Spread,
    ) -> Result<Result<Self, NoNeighbourhood>, L::Error> {
        let ratio = spread.dispersion.sqrt();
        if ratio >= NOISE_RATIO_LIMIT {
            return Ok(Err(NoNeighbourhood::Misfit(ratio)));
        }
        let is_finite = |own: &&DMatrix<f64>| own.iter().all(|entry| entry.is_finite());
        let Some(whole) = spread.covariance.as_ref().filter(is_finite) else {
            return Ok(Err(NoNeighbourhood::Undetermined));
        };
        let of_instruments: Vec<usize> = fit.model.indexed_nuisances().map(|(k, _)| k).collect();
        let parameters = (0..fit.x().len()).filter(|k| !of_instruments.contains(k));
        let parameters: Vec<usize> = parameters.collect();
        let (mut individuals, mut distances) = (Vec::new(), Vec::new());
        for &k in &parameters {
            let step = fit.variables()[k].step;
            let pair = [-step, step].map(|step| {
                let mut change = DVector::zeros(fit.x().len());
                change[k] = step;
                moved(fit, &change)
            });
            distances.push(pair[1].x[k] - pair[0].x[k]);
            individuals.extend(pair.map(|point| point.machine(0)));
        }
        let drawn = if experiments.lab.has_budget(experiments.stage) {
            draw(experiments, fit, (whole, spread.dispersion)).await?
        } else {
            Vec::new()
        };
        individuals.extend(drawn.iter().map(|point| point.machine(0)));
        Ok(Ok(Self {
            individuals,
            distances,
            covariance: whole.select_rows(&parameters).select_columns(&parameters),
            quantile: spread.quantile,
        }))
    }

    /// Returns the number of individuals that lie along the parameters, the first of all.
    pub const fn along_parameters(&self) -> usize {
        2 * self.distances.len()
    }

    /// Computes the 95 % interval of a quantity about its value at the fit, from its values for the individuals, of which
    /// drawn ones may be missing; `None` if a value along a parameter is not finite.
    pub fn interval(&self, at_fit: f64, values: &[f64]) -> Option<QuantityInterval> {
        let (along, drawn) = values.split_at_checked(self.along_parameters())?;
        let pairs = along.chunks_exact(2).zip(&self.distances);
        let slopes = pairs.map(|(pair, distance)| (pair[1] - pair[0]) / distance);
        let slopes = DVector::from_iterator(self.distances.len(), slopes);
        let variance = slopes.dot(&(&self.covariance * &slopes));
        let half_width = self.quantile * variance.max(0.0).sqrt();
        let inside = drawn
            .iter()
            .filter(|own| (**own - at_fit).abs() <= half_width);
        (variance.is_finite() && at_fit.is_finite()).then(|| QuantityInterval {
            half_width,
            drawn: drawn.len(),
            inside: inside.count(),
        })
    }
}

/// Returns a fit's point after a change of its variables, within their bounds.
fn moved(fit: &Fit, change: &DVector<f64>) -> Point {
    let each = fit.x().iter().zip(change.iter()).zip(fit.variables());
    fit.at(each
        .map(|((x, change), own)| (x + change).clamp(own.lower, own.upper))
        .collect())
}

/// Draw from a covariance in two parts.
struct Draw {
    /// Change along the directions that the record determines.
    determined: DVector<f64>,
    /// Change along the other directions.
    undetermined: DVector<f64>,
}

impl Draw {
    fn change(&self, share: f64) -> DVector<f64> {
        &self.determined + share * &self.undetermined
    }
}

/// Draws normal vectors with a positive semidefinite covariance.
fn draws(covariance: &DMatrix<f64>) -> Vec<Draw> {
    let decomposed = covariance.clone().symmetric_eigen();
    let deviations = decomposed.eigenvalues.map(|own| own.max(0.0).sqrt());
    let streams = Streams::new(0, 0);
    let one = |number: usize| {
        let mut stream = streams.at(0, Phase::Resample, number);
        let scaled = deviations.map(|own| own * stream.normal());
        let part = |is_undetermined: bool| {
            let own = scaled.zip_map(&deviations, |z, deviation| {
                if (deviation >= UNDETERMINED) == is_undetermined {
                    z
                } else {
                    0.0
                }
            });
            &decomposed.eigenvectors * own
        };
        Draw {
            determined: part(false),
            undetermined: part(true),
        }
    };
    (0..DRAWN).map(one).collect()
}

/// Draws points from the covariance of a fit, each shortened along the undetermined directions until its misfit rises by
/// no more than that of the whole draw to first order.
async fn draw<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    (covariance, dispersion): (&DMatrix<f64>, f64),
) -> Result<Vec<Point>, L::Error> {
    let at = fit.search.best();
    let cost = |residual: &DVector<f64>, x: &[f64]| {
        residual.norm_squared() + prior_cost(x, fit.variables())
    };
    let draws = draws(covariance);
    let limits = draws.iter().map(|draw| {
        let whole = moved(fit, &draw.change(1.0));
        let change = DVector::from_column_slice(&whole.x) - DVector::from_column_slice(fit.x());
        let residual = &at.residual + &at.jacobian * change;
        let rise = cost(&residual, &whole.x) - fit.search.cost();
        fit.search.cost() + RISE * rise.max(dispersion)
    });
    let limits: Vec<f64> = limits.collect();
    let mut found: Vec<Option<Point>> = vec![None; draws.len()];
    for share in SHARES {
        let open: Vec<usize> = (0..draws.len()).filter(|&k| found[k].is_none()).collect();
        let points = open.iter().map(|&k| moved(fit, &draws[k].change(share)));
        let points: Vec<Point> = points.collect();
        // nothing is left to shorten
        if share <= 0.0 {
            for (k, point) in open.into_iter().zip(points) {
                found[k] = Some(point);
            }
            break;
        }
        let curves = experiments.curves(&points).await?;
        for ((k, point), curves) in open.into_iter().zip(points).zip(curves) {
            let risen = curves.map(|own| cost(&experiments.on.residual(&own), &point.x));
            if risen.is_some_and(|risen| risen <= limits[k]) {
                found[k] = Some(point);
            }
        }
    }
    Ok(found.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(covariance: &[f64; 4]) -> Neighbourhood {
        Neighbourhood {
            individuals: Vec::new(),
            distances: vec![0.04, 0.02],
            covariance: DMatrix::from_row_slice(2, 2, covariance),
            quantile: 2.0,
        }
    }

    /// Checks that a linear quantity has the interval of error propagation: gradient (3, -1), covariance
    /// ((0.04, 0.01), (0.01, 0.09)).
    #[test]
    fn a_linear_quantity_has_the_width_of_error_propagation() {
        let neighbourhood = of(&[0.04, 0.01, 0.01, 0.09]);
        // 5 about the optimum; the second unknown reaches its bound above
        let values = [5.0 - 0.06, 5.0 + 0.06, 5.0 + 0.02, 5.0, 5.8, 4.1, 6.5];
        let expected = 2.0 * (9.0 * 0.04 - 6.0 * 0.01 + 0.09_f64).sqrt();
        let found = neighbourhood.interval(5.0, &values).unwrap();
        assert!((found.half_width - expected).abs() < 1e-12, "{found:?}");
        assert_eq!((found.drawn, found.inside), (3, 2));
        assert!(found.doubt().is_some());
        assert_eq!(neighbourhood.interval(5.0, &[f64::NAN; 4]), None);
        assert_eq!(neighbourhood.interval(f64::INFINITY, &values), None);
    }

    /// Checks that draws have the covariance, here one of rank two, with which a factorisation of Cholesky fails: their
    /// parts lie along the directions below and above the limit.
    #[test]
    fn draws_have_the_covariance_in_two_parts() {
        let covariance =
            DMatrix::from_row_slice(3, 3, &[4.0, -2.0, 0.0, -2.0, 1.0, 0.0, 0.0, 0.0, 0.01]);
        let drawn = draws(&covariance);
        assert_eq!(drawn.len(), DRAWN);
        for own in &drawn {
            let [x, y, z] = [0, 1, 2].map(|k| own.undetermined[k]);
            assert!((x + 2.0 * y).abs() < 1e-9 && z.abs() < 1e-12);
            assert!(own.determined[0].abs() < 1e-9 && own.determined[1].abs() < 1e-9);
            assert!((own.change(0.5)[1] - 0.5 * y).abs() < 1e-9);
        }
        let square =
            |of: &dyn Fn(&Draw) -> f64| drawn.iter().map(|own| of(own).powi(2)).sum::<f64>();
        let squares = [
            square(&|own| own.undetermined[1]),
            square(&|own| 10.0 * own.determined[2]),
        ];
        for square in squares {
            assert!((5.0..50.0).contains(&square), "{squares:?}");
        }
    }
}
