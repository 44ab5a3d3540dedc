//! What the instruments are off by, as a fit has it.
use crate::model::fit::Fit;
use crate::model::tolerated::Tolerated;
use crate::size::spread::Spread;
use crate::thresholds::WITHIN;
use serde::Serialize;

/// A nuisance with its likeliest value.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NeverExact {
    /// The effect that it is, or the gain of a channel.
    pub id: String,
    /// Parameter.
    pub parameter: String,
    /// The likeliest value, as a difference from the absent one.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// 95 % interval, of what was known beforehand and the record together.
    #[serde(rename = "ci95")]
    pub interval: [f64; 2],
    /// What it is good to, one standard deviation.
    pub tolerance: f64,
    /// Whether it lies within three of them.
    pub within: bool,
    /// Whether the tolerance is assumed.
    pub assumed: bool,
}

/// Those of a fit that are no added effects.
pub(crate) fn never_exact(fit: &Fit, spread: &Spread) -> Vec<NeverExact> {
    let one = |(place, one): (usize, &Tolerated)| {
        let own = &one.nuisance;
        let variable = one.variable();
        // in standard deviations of what is known beforehand: that is all where nothing else is
        let variance = spread
            .covariance
            .as_ref()
            .map_or(1.0, |c| c[(place, place)]);
        let (x, half) = (fit.x()[place], spread.quantile * variance.sqrt());
        let bounded = |x: f64| own.deviation * x.clamp(variable.lower, variable.upper);
        NeverExact {
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
    fit.model.placed().map(one).collect()
}
