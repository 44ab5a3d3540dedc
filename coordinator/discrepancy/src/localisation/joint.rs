//! Ranking of joints by how well an unknown periodic force at each would explain the residual.
//!
//! A latent force pair across a joint has harmonics up to a fixed order, whose amplitudes have a prior that
//! falls off with the order. Its Bayes factor against no force is `ln BF = 1/2 u^T (Q^-1 + F)^-1 u - 1/2 ln
//! |I + Q F|`, `u = H^T r`, `F = H^T B H`, `Q = s^2 diag((1 + h/2)^-4)`, maximised over the scale s. Joints
//! within 3 nats, times the dispersion, or 10 % of the best are reported as indistinguishable. The most
//! likely amplitudes give the force over the period, whose shape is a hint at the cause where no listed
//! effect fits.
use crate::linear::evidence::log_determinant;
use crate::linear::tangent::Tangent;
use crate::thresholds::{AMBIGUITY_MARGIN, JOINTS};
use nalgebra::{DMatrix, DVector};
use serde::{Deserialize, Serialize};

/// Evidence for a periodic force at one joint.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointEvidence {
    /// Name of the joint at which the force acts.
    pub joint: String,
    /// Log Bayes factor of a periodic force at the joint against no force (nats).
    pub log_bayes: f64,
    /// Most likely force at the joint, as harmonics of the period.
    pub force: Vec<Harmonic>,
    /// Unit of the force's harmonics.
    pub unit: String,
}

/// One harmonic of a periodic force.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Harmonic {
    /// Order of the harmonic (cycles per period); 0 for a constant.
    pub order: usize,
    /// Whether the harmonic is a sine rather than a cosine of the phase.
    pub sine: bool,
    /// Amplitude of the harmonic, in the unit of the joint's force.
    pub amplitude: f64,
}

/// Signature of a periodic force at one joint: whitened change of the curves per harmonic of the force.
#[derive(Clone, Debug)]
pub struct Latent {
    /// Name of the joint at which the force acts.
    pub joint: String,
    /// Whitened change of the curves by each harmonic; one row per residual entry, one column per harmonic.
    pub columns: DMatrix<f64>,
    /// Harmonics of the force, with the amplitudes for which the signature columns were computed.
    pub parts: Vec<Harmonic>,
    /// Unit of the amplitudes of the force's harmonics.
    pub unit: String,
}

impl JointEvidence {
    /// Returns the most likely force of the joint at a phase of the period (deg), in the force's unit.
    pub fn force_at(&self, phase_deg: f64) -> f64 {
        let part = |part: &Harmonic| {
            let angle = part.order as f64 * phase_deg.to_radians();
            let unit = if part.sine {
                libm::sin(angle)
            } else {
                libm::cos(angle)
            };
            part.amplitude * unit
        };
        self.force.iter().map(part).sum()
    }
}

/// Ranks all joints by the evidence for a periodic force there, the most likely joint first.
pub fn rank(latents: &[Latent], residual: &DVector<f64>, tangent: &Tangent) -> Vec<JointEvidence> {
    let mut ranked: Vec<JointEvidence> = latents
        .iter()
        .map(|latent| evidence(latent, residual, tangent))
        .collect();
    ranked.sort_by(|a, b| b.log_bayes.total_cmp(&a.log_bayes));
    ranked
}

/// Returns the number of leading joints of a ranking that the record cannot tell apart.
pub fn indistinguishable(ranked: &[JointEvidence], dispersion: f64) -> usize {
    let best = ranked.first().map_or(0.0, |first| first.log_bayes);
    let margin = (AMBIGUITY_MARGIN * dispersion).max(JOINTS * best);
    ranked
        .iter()
        .take_while(|one| best - one.log_bayes < margin)
        .count()
}

fn evidence(latent: &Latent, residual: &DVector<f64>, tangent: &Tangent) -> JointEvidence {
    let information = latent
        .columns
        .tr_mul(&tangent.project_columns(&latent.columns));
    let gain = latent.columns.tr_mul(residual);
    let shape = |k: usize| {
        let u = 1.0 + 0.5 * latent.parts[k].order as f64;
        1.0 / (u * u)
    };
    // in amplitudes of the prior's own size: I + s^2 S F S
    let n = gain.len();
    let scaled = DMatrix::from_fn(n, n, |i, j| shape(i) * information[(i, j)] * shape(j));
    let u = DVector::from_fn(n, |i, _| shape(i) * gain[i]);
    let typical = scaled.trace() / n as f64;
    let mut best = (0.0, DVector::zeros(n));
    // scales from hardly visible to overwhelming, four a decade
    for k in -8..=32 {
        let s2 = libm::exp10(0.25 * f64::from(k)) / typical;
        // it moves no channel: no scale
        if !(s2 > 0.0 && s2.is_finite()) {
            break;
        }
        let matrix = DMatrix::identity(n, n) + &scaled * s2;
        let Some(factor) = matrix.cholesky() else {
            continue;
        };
        let likeliest = factor.solve(&u) * s2;
        let log_bayes = 0.5 * u.dot(&likeliest) - 0.5 * log_determinant(&factor);
        if log_bayes > best.0 {
            best = (log_bayes, likeliest);
        }
    }
    let (log_bayes, likeliest) = best;
    let parts = latent.parts.iter().enumerate();
    JointEvidence {
        joint: latent.joint.clone(),
        log_bayes,
        force: parts
            .map(|(k, part)| Harmonic {
                amplitude: shape(k) * likeliest[k] * part.amplitude,
                ..*part
            })
            .collect(),
        unit: latent.unit.clone(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::least_squares::Linearized;
    use search::random::{Phase, Streams};

    /// Checks that the joint of a planted force is ranked first with the force's amplitudes and curve, that
    /// an unrelated joint explains less, and that a joint that moves no channel explains nothing.
    #[test]
    fn the_force_that_acted_is_found() {
        let mut stream = Streams::new(5, 0).at(0, Phase::Initial, 0);
        let entries = 400;
        let mut latent = |joint: &str, size: f64| Latent {
            joint: joint.to_owned(),
            columns: DMatrix::from_fn(entries, 3, |_, _| size * stream.normal()),
            parts: [(0, false), (1, false), (1, true)]
                .map(|(order, sine)| Harmonic {
                    order,
                    sine,
                    amplitude: 800.0,
                })
                .to_vec(),
            unit: "N".to_owned(),
        };
        let latents = [
            latent("other", 2.0),
            latent("own", 2.0),
            latent("none", 0.0),
        ];
        let noise = DVector::from_fn(entries, |_, _| stream.normal());
        let residual = &latents[1].columns * DVector::from_row_slice(&[0.5, 0.0, -1.5]) + noise;
        let nothing = Linearized {
            x: Vec::new(),
            residual: residual.clone(),
            jacobian: DMatrix::zeros(entries, 0),
        };
        let ranked = rank(&latents, &residual, &Tangent::new(&nothing, &[]));
        let names: Vec<&str> = ranked.iter().map(|one| one.joint.as_str()).collect();
        assert_eq!(names[0], "own");
        assert!(ranked[0].log_bayes > 100.0 && ranked[1].log_bayes < 0.05 * ranked[0].log_bayes);
        let none = ranked.iter().find(|one| one.joint == "none").unwrap();
        assert_eq!(none.log_bayes.to_bits(), 0.0_f64.to_bits());
        assert!(none.force_at(77.0).abs() < 1e-12);
        // four standard errors of an amplitude: 800 N over 2 sqrt(400)
        let force = |turn: f64| ranked[0].force_at(turn);
        assert!((force(0.0) - 400.0).abs() < 80.0 * 2.0, "{}", force(0.0));
        assert!((force(90.0) - (400.0 - 1200.0)).abs() < 80.0 * 2.0);
        assert!((force(270.0) - (400.0 + 1200.0)).abs() < 80.0 * 2.0);
        assert!((force(360.0) - force(0.0)).abs() < 1e-9);
    }
}
