//! Detection limits: the size from which an effect would be detected, independent of any verdict.
use crate::hypothesis::round::WorkingRound;
use crate::linear::isolability::{DetectionThreshold, detection_limit};
use crate::linear::score::single;
use crate::model::fit::Fit;
use crate::model::parameter::sizes;
use protocol::announce::Sign;
use serde::{Deserialize, Serialize};

/// Detection limit of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limit {
    /// Identifier of the effect.
    pub id: String,
    /// Name of the parameter that sets the effect's size.
    pub parameter: String,
    /// Unit of the detection limit.
    pub unit: String,
    /// Smallest size of the effect that would be detected; infinite where recalibration absorbs the effect.
    pub size: f64,
    /// Largest size within the parameter's bounds.
    pub largest: f64,
}

impl Limit {
    /// Returns whether some size within the parameter's bounds would be detected.
    pub fn is_within_bounds(&self) -> bool {
        self.size <= self.largest
    }
}

/// Computes the detection limits of all effects of a round, at a family-wise level `alpha`.
pub(crate) fn limits(round: &WorkingRound, fit: &Fit, alpha: f64) -> Vec<Limit> {
    let tangent = fit.tangent();
    let mut limits = Vec::new();
    for suspect in round
        .candidates
        .iter()
        .filter(|suspect| suspect.signature.ncols() > 0)
    {
        let hurdle = DetectionThreshold {
            p_value: single(alpha, suspect.tries * round.candidates.len()),
            dispersion: fit.misfit(),
        };
        let sizes = sizes(&suspect.effect);
        for (column, &k) in sizes.iter().enumerate() {
            let parameter = &suspect.effect.parameters[k];
            let one_sided = sizes.len() == 1 && parameter.sign == Sign::Positive;
            let limit = detection_limit(&suspect.signature, column, one_sided, &tangent, &hurdle);
            limits.push(Limit {
                id: suspect.effect.id.clone(),
                parameter: parameter.name.clone(),
                unit: parameter.unit.clone(),
                size: limit * parameter.scale,
                largest: (parameter.upper - parameter.absent)
                    .abs()
                    .max((parameter.absent - parameter.lower).abs()),
            });
        }
    }
    limits
}
