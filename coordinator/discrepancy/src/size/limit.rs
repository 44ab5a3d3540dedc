//! Detection limits: from which size on an effect would have been seen, before any verdict.
use crate::cause::round::Round;
use crate::linear::isolability::{Hurdle, detection_limit};
use crate::linear::score::single;
use crate::model::fit::Fit;
use crate::model::parameter::sizes;
use protocol::announce::Sign;
use serde::Serialize;

/// From which size on an effect would have been seen.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// Identifier.
    pub id: String,
    /// Parameter.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// The size; infinite where recalibration absorbs the effect.
    pub size: f64,
    /// The largest size within the parameter's bounds.
    #[serde(skip)]
    pub largest: f64,
}

impl Limit {
    /// Whether some size within the parameter's bounds would be seen.
    pub fn is_within_bounds(&self) -> bool {
        self.size <= self.largest
    }
}

/// Detection limits of all effects of a round, at a level of the family of their tests.
pub(crate) fn limits(round: &Round, fit: &Fit, alpha: f64) -> Vec<Limit> {
    let tangent = fit.tangent();
    let mut limits = Vec::new();
    for suspect in round
        .suspects
        .iter()
        .filter(|suspect| suspect.signature.ncols() > 0)
    {
        let hurdle = Hurdle {
            p_value: single(alpha, suspect.tries * round.suspects.len()),
            dispersion: fit.dispersion(),
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
