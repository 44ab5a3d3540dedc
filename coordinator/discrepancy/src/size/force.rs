//! The force without a cause that beats every name: where it acts, its form, how large it is and what
//! it explains.
use crate::cause::challenge::Challenger;
use crate::cause::round::Round;
use crate::model::fit::Fit;
use crate::model::probe;
use crate::proof::compare::Row;
use crate::record::metric::Metric;
use crate::size::spread::Spread;

/// A force without a cause, with its size and what it explains.
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
    /// Log evidence against the model without it, over the dispersion (nats).
    pub ln_evidence: f64,
    /// The model with it.
    pub fit: Fit,
    /// The gap before and after it, by record.
    pub rows: Vec<Row>,
}

/// The force of a challenger that beat the model `before` it in a round; without its rows yet.
pub(crate) fn force(
    challenger: Challenger,
    (before, metric): (&Fit, &Metric),
    round: &Round,
) -> Force {
    let fit = challenger.fit;
    let first = before.model.added.len();
    let parts = &fit.model.added[first..];
    let scale = |k: usize| parts[k].parameters.first().map_or(1.0, |p| p.scale);
    let place = |k: usize| fit.model.first_of(first + k);
    let size = |k: usize| scale(k) * fit.x()[place(k)];
    let spread = Spread::of(metric, &fit);
    let variance = |j: usize, k: usize| {
        let own = spread.covariance.as_ref().map(|c| c[(place(j), place(k))]);
        own.map_or(f64::INFINITY, |own| scale(j) * scale(k) * own)
    };
    let (amplitude, deviation, phase_deg) = match parts {
        [one, _] => {
            let (a, b) = (size(0), size(1));
            let amplitude = libm::hypot(a, b);
            let (u, v) = (a / amplitude, b / amplitude);
            let square =
                u * u * variance(0, 0) + 2.0 * u * v * variance(0, 1) + v * v * variance(1, 1);
            let (cosine, sine) = if probe::is_sine(&one.id) {
                (b, a)
            } else {
                (a, b)
            };
            let phase_deg = libm::atan2(sine, cosine).to_degrees();
            (amplitude, square.sqrt(), Some(phase_deg))
        }
        _ => (size(0), variance(0, 0).sqrt(), None),
    };
    let half = spread.quantile * deviation;
    let lowest = phase_deg.map_or(f64::NEG_INFINITY, |_| 0.0);
    let stronger = parts.first();
    let unit = stronger
        .and_then(|part| part.parameters.first())
        .map(|p| p.unit.clone());
    let form = probe::harmonic(&challenger.id).map(|order| format!("harmonic {order}"));
    Force {
        joint: stronger.map(|part| part.joint.clone()).unwrap_or_default(),
        form: form.unwrap_or_else(|| probe::form(&challenger.id).to_owned()),
        unit: unit.unwrap_or_default(),
        interval: [(amplitude - half).max(lowest), amplitude + half],
        amplitude,
        phase_deg,
        ln_evidence: round.nats(challenger.log_evidence),
        id: challenger.id,
        fit,
        rows: Vec::new(),
    }
}
