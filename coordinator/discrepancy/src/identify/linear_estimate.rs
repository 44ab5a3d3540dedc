//! Quick linear identifiability analysis from one linearised simulation at given parameters.
//!
//! It assumes the noise of the record alone, without instrument tolerances, numerical error or refits. A
//! residual above the noise widens every interval. The result accompanies the table of a calibration;
//! [`super::identify`] computes profile likelihoods instead.
use super::answer::{Determination, IntervalEnd, UnknownEstimate};
use super::settings::FREE;
use crate::estimate::spread::Spread;
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::unknowns::{DefaultPrior, FittedModel, Point};
use crate::thresholds::NOISE_RATIO_LIMIT;
use nalgebra::{DMatrix, DVector};
use protocol::case::Scale;
use record::Curves;
use search::least_squares::LeastSquaresSettings;
use search::space::Space;

/// Linear estimate of the searched unknowns at given parameters.
#[derive(Clone, Debug)]
pub struct LinearEstimate {
    /// Searched unknowns with their intervals.
    pub unknowns: Vec<UnknownEstimate>,
    /// Derivatives of the simulated channels of the record by each searched unknown: per decade on a logarithmic scale, else
    /// per declared unit. Channels without an absolute zero have derivatives up to a constant.
    pub derivatives: Vec<Curves>,
    /// Index of each channel of the record among the channels of its condition.
    pub channels: Vec<usize>,
    /// Misfit of the fit in units of the noise, as a ratio of amplitudes; at least 1.
    pub noise_ratio: f64,
    /// Individuals beside the estimate, by which a quantity is differentiated and given an interval; `None` where the
    /// information matrix is singular, or where the fit leaves so much more than noise that its numbers are not those of
    /// the machine.
    pub neighbours: Option<Neighbours>,
}

/// Step to either side of the estimate, in coordinates of the search: 0.02 decades on a logarithmic scale.
const STEP: f64 = 0.02;

/// Individuals to either side of an estimate along each searched unknown, with the covariance of the unknowns.
#[derive(Clone, Debug)]
pub struct Neighbours {
    /// Values of all unknowns \[declared units\]: below and above along the first searched unknown, then the second, and
    /// so on; length 2 n for n searched unknowns.
    pub individuals: Vec<Vec<f64>>,
    /// Distance between the two individuals of each pair, in coordinates of the search; length n.
    distances: Vec<f64>,
    /// Covariance of the searched unknowns in coordinates of the search; n x n.
    covariance: DMatrix<f64>,
    /// Half-width of a 95 % interval in standard deviations.
    quantile: f64,
}

impl Neighbours {
    fn new(space: &Space, at: &[f64], (covariance, quantile): (DMatrix<f64>, f64)) -> Self {
        let (mut individuals, mut distances) = (Vec::new(), Vec::new());
        for (k, axis) in space.axes().iter().enumerate() {
            let bounds = axis.interval();
            let ends = [-STEP, STEP].map(|step| (at[k] + step).clamp(bounds.from, bounds.to));
            for end in ends {
                let mut point = at.to_vec();
                point[k] = end;
                individuals.push(space.values(&point));
            }
            distances.push(ends[1] - ends[0]);
        }
        Self {
            individuals,
            distances,
            covariance,
            quantile,
        }
    }

    /// Returns the half-width of the 95 % interval of a quantity to first order, from its values for the individuals;
    /// `None` if one of them is not finite.
    pub fn half_width(&self, values: &[f64]) -> Option<f64> {
        let pairs = values.chunks_exact(2).zip(&self.distances);
        let slopes = pairs.map(|(pair, distance)| (pair[1] - pair[0]) / distance);
        let slopes = DVector::from_iterator(self.distances.len(), slopes);
        let variance = slopes.dot(&(&self.covariance * &slopes));
        variance
            .is_finite()
            .then(|| self.quantile * variance.max(0.0).sqrt())
    }
}

/// Estimates the searched unknowns to first order from the record of the calibrated condition, at the start point that the
/// inputs state. Returns `None` without a record or a start point, or if the simulation does not complete.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn linear_estimate<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
) -> Result<Option<LinearEstimate>, L::Error> {
    let record = inputs.records.first().filter(|record| record.is_fitted());
    let (Some(record), Some(x)) = (record, &inputs.start) else {
        return Ok(None);
    };
    let orders = inputs.thresholds.orders;
    let on = WhitenedRecord::under_own_noise(record.free(), orders, inputs.usual.clone());
    let model = FittedModel {
        unstated: DefaultPrior::Bounds,
        ..FittedModel::plain(inputs.space.clone())
    };
    let mut experiments = Experiments {
        lab,
        on: &on,
        stage: Stage::Show,
    };
    let point = Point {
        model,
        x: x.clone(),
    };
    // one Jacobian where it is
    let still = LeastSquaresSettings {
        iterations: 1,
        ..FREE
    };
    let Some(fit) = experiments.fit(point, still).await? else {
        return Ok(None);
    };
    let spread = Spread::of(&on.metric, &fit);
    let axes = fit.model.space.axes().iter().enumerate();
    let estimate = axes.map(|(k, axis)| {
        let half = spread.quantile * spread.variance(k).sqrt();
        let (at, bounds) = (fit.x()[k], axis.interval());
        let ends = [at - half > bounds.from, at + half < bounds.to];
        let [below, above] = ends;
        UnknownEstimate {
            name: axis.unknown.name.clone(),
            unit: axis.unknown.unit.clone(),
            value: axis.value(at),
            interval: [
                below.then(|| axis.value(at - half)),
                above.then(|| axis.value(at + half)),
            ],
            ends: ends.map(|rises| {
                if rises {
                    IntervalEnd::Rises
                } else {
                    IntervalEnd::Bound
                }
            }),
            seen: Determination::of(below, above),
            correlated: Vec::new(),
            profile: Vec::new(),
        }
    });
    let jacobian = &fit.search.best().jacobian;
    let derivatives = fit.model.space.axes().iter().enumerate().map(|(k, axis)| {
        let unknown = &axis.unknown;
        // the residual is measured less simulated
        let coordinates = match unknown.scale {
            Scale::Logarithmic => -1.0,
            Scale::Linear => -2.0 / (unknown.upper - unknown.lower),
        };
        let column = jacobian.column(k) * coordinates;
        on.metric.curves(&column.into_owned())
    });
    let noise_ratio = spread.dispersion.max(1.0).sqrt();
    Ok(Some(LinearEstimate {
        unknowns: estimate.collect(),
        derivatives: derivatives.collect(),
        channels: on.record.channels.iter().map(|own| own.curve).collect(),
        noise_ratio,
        neighbours: spread
            .covariance
            .filter(|_| noise_ratio < NOISE_RATIO_LIMIT)
            .map(|own| Neighbours::new(&fit.model.space, fit.x(), (own, spread.quantile))),
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a linear quantity has the half-width of error propagation: gradient (3, -1), covariance
    /// ((0.04, 0.01), (0.01, 0.09)).
    #[test]
    fn a_linear_quantity_has_the_width_of_error_propagation() {
        let neighbours = Neighbours {
            individuals: Vec::new(),
            distances: vec![0.04, 0.02],
            covariance: DMatrix::from_row_slice(2, 2, &[0.04, 0.01, 0.01, 0.09]),
            quantile: 2.0,
        };
        // 5 about the optimum; the second unknown reaches its bound above
        let values = [5.0 - 0.06, 5.0 + 0.06, 5.0 + 0.02, 5.0];
        let expected = 2.0 * (9.0 * 0.04 - 6.0 * 0.01 + 0.09_f64).sqrt();
        let half = neighbours.half_width(&values).unwrap();
        assert!((half - expected).abs() < 1e-12, "{half} {expected}");
        assert_eq!(neighbours.half_width(&[f64::NAN; 4]), None);
    }
}
