//! The force without a cause that beats every name: where it acts, its form, how large it is and what
//! it explains.
use crate::bench::Fit;
use crate::estimate::{QUANTILE, covariance};
use crate::rounds::Round;
use crate::stage::challenge::Challenger;
use crate::stage::show::Row;
use crate::stage::whereabouts;

/// Such a force.
#[derive(Clone, Debug)]
pub struct Force {
    /// Identifier of its form; of a harmonic, of the stronger phase.
    pub id: String,
    /// Where it acts.
    pub joint: String,
    /// Its form: the last part of the identifier; of a harmonic, with both phases.
    pub form: String,
    /// Its amplitude.
    pub amplitude: f64,
    /// Unit of the amplitude.
    pub unit: String,
    /// 95 % interval of the amplitude.
    pub interval: [f64; 2],
    /// Of a harmonic, the phase of the harmonic at which it is largest (deg).
    pub phase_deg: Option<f64>,
    /// Log evidence against the model without it, over the squared misfit (nats).
    pub ln_evidence: f64,
    /// The model with it.
    pub fit: Fit,
    /// The gap before and after it, by record.
    pub rows: Vec<Row>,
}

/// The force of a challenger that beat the model `before` it in a round; without its rows yet.
pub(crate) fn force(challenger: Challenger, before: &Fit, round: &Round) -> Force {
    let fit = challenger.fit;
    let first = before.model.added.len();
    let parts = &fit.model.added[first..];
    let scale = |k: usize| parts[k].parameters.first().map_or(1.0, |p| p.scale);
    let place = |k: usize| fit.model.first_of(first + k);
    let covariance = covariance(&fit, round.phi);
    let variance = |j: usize, k: usize| {
        let own = covariance.as_ref();
        own.map_or(f64::INFINITY, |c| {
            scale(j) * scale(k) * c[(place(j), place(k))]
        })
    };
    let size = |k: usize| scale(k) * fit.x()[place(k)];
    let whole = order(&challenger.id);
    let (amplitude, deviation, phase_deg) = match parts {
        [_, _] => {
            let (a, b) = (size(0), size(1));
            let amplitude = libm::hypot(a, b);
            let (u, v) = (a / amplitude, b / amplitude);
            let square =
                u * u * variance(0, 0) + 2.0 * u * v * variance(0, 1) + v * v * variance(1, 1);
            let sine_first = whereabouts::is_sine(&parts[0].id);
            let (cosine, sine) = if sine_first { (b, a) } else { (a, b) };
            (
                amplitude,
                square.sqrt(),
                Some(libm::atan2(sine, cosine).to_degrees()),
            )
        }
        _ => (size(0), variance(0, 0).sqrt(), None),
    };
    let half = QUANTILE * deviation;
    let lowest = if phase_deg.is_some() {
        0.0
    } else {
        f64::NEG_INFINITY
    };
    Force {
        joint: parts
            .first()
            .map(|part| part.joint.clone())
            .unwrap_or_default(),
        form: whole.map_or_else(
            || whereabouts::form(&challenger.id).to_owned(),
            |order| format!("harmonic {order}"),
        ),
        unit: parts
            .first()
            .and_then(|part| part.parameters.first())
            .map(|p| p.unit.clone())
            .unwrap_or_default(),
        interval: [(amplitude - half).max(lowest), amplitude + half],
        amplitude,
        phase_deg,
        ln_evidence: (challenger.log_evidence - round.null_evidence) / (round.phi * round.phi),
        id: challenger.id,
        fit,
        rows: Vec::new(),
    }
}

/// The order of a harmonic of the crank.
fn order(id: &str) -> Option<usize> {
    whereabouts::probe_order(id).filter(|order| *order > 0)
}
