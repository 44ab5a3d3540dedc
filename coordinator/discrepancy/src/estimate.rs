//! Numbers of the answer: sizes with intervals, and detection limits.
use crate::bench::Fit;
use crate::evidence::misfit;
use crate::isolability::{self, Hurdle};
use crate::model::sizes;
use crate::rounds::Round;
use crate::score::{family_wise, single};
use crate::settings::Settings;
use crate::stage::establish::Base;
use crate::stage::refit::Refitted;
use crate::tangent::Tangent;
use nalgebra::DMatrix;
use protocol::announce::Sign;

/// An effect of the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Identifier.
    pub id: String,
    /// In words.
    pub title: String,
    /// Name, unit, value and 95 % interval of each parameter.
    pub parameters: Vec<(String, String, f64, [f64; 2])>,
    /// Family-wise p-value of its score test.
    pub p_value: f64,
    /// Log evidence against the model without it, over the squared misfit (nats).
    pub ln_evidence: f64,
}

/// From which size on an effect would have been seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Identifier.
    pub id: String,
    /// Parameter.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// The size; infinite where recalibration absorbs the effect.
    pub size: f64,
}

/// Half-width of a 95 % interval in standard deviations: Student's, for the nine degrees of freedom
/// that the variance of a low order has from a handful of cycles.
pub(crate) const QUANTILE: f64 = 2.262;

/// Detection limits of all effects, before any verdict.
pub(crate) fn limits(round: &Round, fit: &Fit, base: &Base, settings: &Settings) -> Vec<Limit> {
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let phi = misfit(fit.chi_squared(), base.bench.metric.len());
    let mut limits = Vec::new();
    for suspect in &round.suspects {
        if suspect.signature.ncols() == 0 {
            continue;
        }
        let tests = suspect.tries * round.suspects.len();
        let hurdle = Hurdle {
            p_value: single(settings.alpha, tests),
            phi,
        };
        let sizes = sizes(&suspect.effect);
        for (column, &k) in sizes.iter().enumerate() {
            let parameter = &suspect.effect.parameters[k];
            let one_sided = sizes.len() == 1 && parameter.sign == Sign::Positive;
            let signature = &suspect.signature;
            let limit =
                isolability::detection_limit(signature, column, one_sided, &tangent, &hurdle);
            limits.push(Limit {
                id: suspect.effect.id.clone(),
                parameter: parameter.name.clone(),
                unit: parameter.unit.clone(),
                size: limit * parameter.scale,
            });
        }
    }
    limits
}

/// The added effects with their sizes, then the other members of their sets.
pub(crate) fn estimates(rounds: &[Round], after: &Fit) -> Vec<Estimate> {
    let mut found: Vec<Estimate> = Vec::new();
    for added_first in [true, false] {
        for round in rounds {
            let members = round
                .set
                .iter()
                .filter(|id| (round.added.as_ref() == Some(id)) == added_first);
            for id in members {
                let refitted = round.refits.iter().find(|r| r.id == *id);
                if let Some(refitted) = refitted.filter(|_| found.iter().all(|e| e.id != *id)) {
                    found.push(estimate(round, refitted, after));
                }
            }
        }
    }
    found
}

/// Sizes of an added effect are those of the final model, beside everything else that was added; of
/// a rival, those of its own refit.
fn estimate(round: &Round, refitted: &Refitted, after: &Fit) -> Estimate {
    let in_answer = after.model.added.iter().any(|e| e.id == refitted.id);
    let fit = if in_answer { after } else { &refitted.fit };
    let model = &fit.model;
    let position = model.added.iter().position(|e| e.id == refitted.id);
    let position = position.unwrap_or_default();
    let effect = &model.added[position];
    let first = model.first_of(position);
    let deviations = deviations(fit, round.phi);
    let parameters = effect.parameters.iter().enumerate().map(|(k, p)| {
        let x = fit.x()[first + k];
        let half = QUANTILE * deviations[first + k] * p.scale;
        let value = (p.absent + x * p.scale).clamp(p.lower, p.upper);
        let interval = [(value - half).max(p.lower), (value + half).min(p.upper)];
        (p.name.clone(), p.unit.clone(), value, interval)
    });
    Estimate {
        id: refitted.id.clone(),
        title: effect.title.clone(),
        parameters: parameters.collect(),
        p_value: round
            .suspects
            .iter()
            .find(|s| s.effect.id == refitted.id)
            .map_or(1.0, |s| family_wise(s.p_value(), round.suspects.len())),
        ln_evidence: (refitted.log_evidence - round.null_evidence) / (round.phi * round.phi),
    }
}

/// Standard deviations of a fit's unknowns, inflated by the misfit.
fn deviations(fit: &Fit, phi: f64) -> Vec<f64> {
    covariance(fit, phi).map_or_else(
        || vec![f64::INFINITY; fit.x().len()],
        |covariance| covariance.diagonal().iter().map(|v| v.sqrt()).collect(),
    )
}

/// Covariance of a fit's unknowns, inflated by the misfit; nothing where the fit leaves one of them
/// open.
pub(crate) fn covariance(fit: &Fit, phi: f64) -> Option<DMatrix<f64>> {
    let at = fit.search.best();
    let mut curvature = at.jacobian.tr_mul(&at.jacobian);
    for (k, v) in fit.variables().iter().enumerate() {
        if let Some(prior) = v.prior {
            curvature[(k, k)] += 1.0 / (prior.deviation * prior.deviation);
        }
    }
    Some(curvature.cholesky()?.inverse() * (phi * phi))
}
