//! Candidate effect: its signature at a fitted point and its test.
use crate::linear::score::{Score, family_wise};
use nalgebra::{DMatrix, DVector, Matrix};
use protocol::announce::EffectDescriptor;
use serde::{Deserialize, Serialize};

/// Candidate effect with its signature.
pub(crate) type WorkingCandidate = CandidateEffect<DMatrix<f64>>;

/// Candidate effect with its test.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct CandidateEffect<S = f64> {
    /// Effect under test.
    pub effect: EffectDescriptor,
    /// Result of the score test; `None` where the effect could not be simulated.
    pub score: Option<Score>,
    /// Scaled parameters of the effect as estimated by the test, from which a refit starts.
    pub start: Vec<f64>,
    /// Further scaled parameters from which a non-linear effect may be refitted, likeliest first: the tested
    /// sizes at which the curves change by more than noise.
    pub rungs: Vec<Vec<f64>>,
    /// Whether the curves change in proportion to the effect's size.
    pub linear: bool,
    /// Signature: whitened change of the curves per unit of each size of the effect, one matrix column per size; in a
    /// summary its squared length alone.
    pub signature: S,
    /// Scaled parameters at which each signature column was computed, with all other sizes absent.
    pub taken: Vec<Vec<f64>>,
    /// Number of parameter shapes and sizes at which the effect was tested.
    pub tries: usize,
}

impl<S> CandidateEffect<S> {
    /// Returns the p-value of the effect's score test, corrected for the number of shapes and sizes tried.
    pub fn p_value(&self) -> f64 {
        self.score
            .as_ref()
            .map_or(1.0, |score| family_wise(score.p_value, self.tries))
    }

    /// Returns the score-test statistic of the effect; 0 without a test or where the estimate has the wrong
    /// sign.
    pub fn statistic(&self) -> f64 {
        self.score.as_ref().map_or(0.0, |score| {
            if score.p_value < 1.0 {
                score.statistic
            } else {
                0.0
            }
        })
    }
}

impl WorkingCandidate {
    /// Returns the test with the squared length of the signature in its place.
    pub(crate) fn summary(self) -> CandidateEffect {
        CandidateEffect {
            effect: self.effect,
            score: self.score,
            start: self.start,
            rungs: self.rungs,
            linear: self.linear,
            signature: self.signature.norm_squared(),
            taken: self.taken,
            tries: self.tries,
        }
    }
}

/// Returns the candidate effects with a positive statistic, likeliest first.
pub(crate) fn ranked(suspects: &[WorkingCandidate]) -> Vec<&WorkingCandidate> {
    let mut order: Vec<&WorkingCandidate> =
        suspects.iter().filter(|s| s.statistic() > 0.0).collect();
    order.sort_by(|a, b| {
        a.p_value()
            .total_cmp(&b.p_value())
            .then(b.statistic().total_cmp(&a.statistic()))
    });
    order
}

/// Concatenates the signature columns of several effects.
pub(crate) fn joined(parts: &[&WorkingCandidate]) -> DMatrix<f64> {
    let columns = parts.iter().flat_map(|part| part.signature.column_iter());
    let columns: Vec<DVector<f64>> = columns.map(Matrix::into_owned).collect();
    DMatrix::from_columns(&columns)
}
