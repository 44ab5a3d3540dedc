//! Joint: where in the machine an unknown periodic force would explain the residual best.
//!
//! A latent force pair across a joint with harmonics up to `H_f`, whose amplitudes have a prior that
//! falls off with the order, has the Bayes factor
//! `ln BF = 1/2 u^T (Q^-1 + F)^-1 u - 1/2 ln |I + Q F|`, `u = H^T r`, `F = H^T B H`,
//! `Q = s^2 diag((1 + h/2)^-4)`, maximised over the scale s. Joints within `max(3 phi^2, 10 %)` nats
//! of the best are not told apart.
use crate::tangent::Tangent;
use nalgebra::{DMatrix, DVector};

/// The case for one joint.
#[derive(Clone, Debug, PartialEq)]
pub struct JointEvidence {
    /// Its name.
    pub joint: String,
    /// Log Bayes factor against no force (nats).
    pub log_bayes: f64,
}

/// One joint's columns: whitened change per unit amplitude, with the order of each (0 for a constant).
#[derive(Clone, Debug)]
pub struct Latent {
    /// Name of the joint.
    pub joint: String,
    /// Entries x amplitudes.
    pub columns: DMatrix<f64>,
    /// Order of each amplitude.
    pub orders: Vec<usize>,
}

/// All joints, the most likely first.
pub fn rank(latents: &[Latent], residual: &DVector<f64>, tangent: &Tangent) -> Vec<JointEvidence> {
    let mut ranked: Vec<JointEvidence> = latents
        .iter()
        .map(|latent| JointEvidence {
            joint: latent.joint.clone(),
            log_bayes: log_bayes(latent, residual, tangent),
        })
        .collect();
    ranked.sort_by(|a, b| b.log_bayes.total_cmp(&a.log_bayes));
    ranked
}

/// How many of a ranking, from the first on, are not told apart.
pub fn indistinguishable(ranked: &[JointEvidence], phi: f64) -> usize {
    let best = ranked.first().map_or(0.0, |first| first.log_bayes);
    let margin = (3.0 * phi * phi).max(0.1 * best);
    ranked
        .iter()
        .take_while(|one| best - one.log_bayes < margin)
        .count()
}

fn log_bayes(latent: &Latent, residual: &DVector<f64>, tangent: &Tangent) -> f64 {
    let information = latent
        .columns
        .tr_mul(&tangent.project_columns(&latent.columns));
    let gain = latent.columns.tr_mul(residual);
    let shape = |k: usize| {
        let u = 1.0 + 0.5 * latent.orders[k] as f64;
        1.0 / (u * u)
    };
    // in amplitudes of the prior's own size: I + s^2 S F S
    let n = gain.len();
    let scaled = DMatrix::from_fn(n, n, |i, j| shape(i) * information[(i, j)] * shape(j));
    let u = DVector::from_fn(n, |i, _| shape(i) * gain[i]);
    let typical = scaled.trace() / n as f64;
    if typical.is_nan() || typical <= 0.0 {
        return 0.0;
    }
    let at = |s2: f64| -> f64 {
        let matrix = DMatrix::identity(n, n) + &scaled * s2;
        let Some(factor) = matrix.cholesky() else {
            return 0.0;
        };
        let log_determinant: f64 = factor
            .l_dirty()
            .diagonal()
            .iter()
            .map(|d| 2.0 * libm::log(*d))
            .sum();
        0.5 * s2 * u.dot(&factor.solve(&u)) - 0.5 * log_determinant
    };
    // scales from hardly visible to overwhelming, four a decade
    (-8..=32)
        .map(|k| at(libm::exp10(0.25 * f64::from(k)) / typical))
        .fold(0.0, f64::max)
}
