//! Generic force (a force without a physical cause) that explains the residual better than every listed
//! effect: where it acts, its form, its amplitude and the misfit that it removes.
use crate::estimate::spread::Spread;
use crate::hypothesis::generic_force::Challenger;
use crate::model::fit::{Fit, FitSummary};
use crate::model::probe;
use crate::validation::compare::GapRow;
use record::metric::Metric;
use serde::{Deserialize, Serialize};

/// Generic force with its estimated amplitude and the misfit that it removes.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct ForceEstimate<F = FitSummary> {
    /// Identifier of the generic force; for a harmonic, that of the stronger phase.
    pub id: String,
    /// Joint at which the force acts.
    pub joint: String,
    /// Form of the force: the last part of the identifier, or for a harmonic, which has both phases,
    /// `harmonic` and its order.
    pub form: String,
    /// Amplitude of the force.
    pub amplitude: f64,
    /// Unit of the amplitude.
    pub unit: String,
    /// 95 % interval of the amplitude.
    pub interval: [f64; 2],
    /// Phase at which a harmonic is largest (deg of the harmonic); `None` for other forms.
    pub phase_deg: Option<f64>,
    /// Log evidence of the model with the force against the model without it, divided by the dispersion
    /// (nats).
    pub ln_evidence: f64,
    /// Fit of the model with the force.
    pub fit: F,
    /// Misfit to each record before and after the force is added.
    pub rows: Vec<GapRow>,
}

impl ForceEstimate<Fit> {
    /// Returns the estimate with a summary of its fit.
    pub(crate) fn summary(self) -> ForceEstimate {
        ForceEstimate {
            fit: self.fit.summary(),
            id: self.id,
            joint: self.joint,
            form: self.form,
            amplitude: self.amplitude,
            unit: self.unit,
            interval: self.interval,
            phase_deg: self.phase_deg,
            ln_evidence: self.ln_evidence,
            rows: self.rows,
        }
    }
}

/// Builds the report of a generic force (`challenger`) that beat the model `before`; the misfits by record
/// are still empty.
pub(crate) fn force(
    challenger: Challenger,
    (before, metric): (&Fit, &Metric),
) -> ForceEstimate<Fit> {
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
    ForceEstimate {
        joint: stronger.map(|part| part.joint.clone()).unwrap_or_default(),
        form: form.unwrap_or_else(|| probe::form(&challenger.id).to_owned()),
        unit: unit.unwrap_or_default(),
        interval: [(amplitude - half).max(lowest), amplitude + half],
        amplitude,
        phase_deg,
        ln_evidence: challenger.gained,
        id: challenger.id,
        fit,
        rows: Vec::new(),
    }
}
