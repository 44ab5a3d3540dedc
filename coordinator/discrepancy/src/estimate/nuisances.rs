//! Estimated nuisance parameters of a fit, such as errors of the instruments.
use crate::estimate::spread::Spread;
use crate::model::fit::Fit;
use crate::model::nuisance_parameter::NuisanceParameter;
use crate::thresholds::WITHIN;
use serde::{Deserialize, Serialize};

/// Nuisance parameter with its most likely value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NuisanceEstimate {
    /// Identifier of the effect that the nuisance parameter stands for, or of the gain of a channel.
    pub id: String,
    /// Name of the nuisance parameter.
    pub parameter: String,
    /// Most likely value of the nuisance parameter, as the difference from the value at which it has no
    /// effect.
    pub value: f64,
    /// Unit of the value.
    pub unit: String,
    /// 95 % interval of the nuisance parameter, from its prior and the record together.
    #[serde(rename = "ci95")]
    pub interval: [f64; 2],
    /// Prior standard deviation of the nuisance parameter.
    pub tolerance: f64,
    /// Whether the estimated value lies within three prior standard deviations.
    pub within: bool,
    /// Whether the prior standard deviation is assumed rather than stated.
    pub assumed: bool,
}

/// Returns the nuisance parameters of a fit that no added effect replaces.
pub(crate) fn nuisance_estimates(fit: &Fit, spread: &Spread) -> Vec<NuisanceEstimate> {
    let one = |(place, one): (usize, &NuisanceParameter)| {
        let own = &one.nuisance;
        let variable = one.variable();
        // in standard deviations of what is known beforehand: that is all where nothing else is
        let variance = spread
            .covariance
            .as_ref()
            .map_or(1.0, |c| c[(place, place)]);
        let (x, half) = (fit.x()[place], spread.quantile * variance.sqrt());
        let bounded = |x: f64| own.deviation * x.clamp(variable.lower, variable.upper);
        NuisanceEstimate {
            id: own.id.clone(),
            parameter: own.parameter.clone(),
            value: own.deviation * x,
            unit: own.unit.clone(),
            interval: [bounded(x - half), bounded(x + half)],
            tolerance: own.deviation,
            within: x.abs() <= WITHIN,
            assumed: own.assumed,
        }
    };
    fit.model.indexed_nuisances().map(one).collect()
}
