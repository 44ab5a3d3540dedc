//! An effect under suspicion: its signature at a fitted point, and what the test of it says.
use crate::linear::score::{Score, family_wise};
use nalgebra::{DMatrix, DVector, Matrix};
use protocol::announce::EffectDescriptor;

/// An effect with its test.
#[derive(Clone, Debug)]
pub struct Suspect {
    /// What it is.
    pub effect: EffectDescriptor,
    /// The test; nothing where the effect could not be simulated.
    pub score: Option<Score>,
    /// Scaled values of its parameters that the test suggests.
    pub start: Vec<f64>,
    /// Other scaled values of its parameters from which it may be refitted, the likeliest first: those at which an effect
    /// that is not linear changes the curves by more than noise.
    pub rungs: Vec<Vec<f64>>,
    /// Whether the curves change in proportion to its size.
    pub linear: bool,
    /// Whitened change per unit of each size; columns in the order of the sizes.
    pub signature: DMatrix<f64>,
    /// The effect's scaled parameters with which each column was taken, all other sizes absent.
    pub taken: Vec<Vec<f64>>,
    /// How many shapes were tried.
    pub tries: usize,
}

impl Suspect {
    /// Tail probability, the best of several shapes counted as such.
    pub fn p_value(&self) -> f64 {
        self.score
            .as_ref()
            .map_or(1.0, |score| family_wise(score.p_value, self.tries))
    }

    /// The statistic; 0 without a test or where the estimate has the wrong sign.
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

/// Suspects whose test speaks for them, the likeliest first.
pub(crate) fn ranked(suspects: &[Suspect]) -> Vec<&Suspect> {
    let mut order: Vec<&Suspect> = suspects.iter().filter(|s| s.statistic() > 0.0).collect();
    order.sort_by(|a, b| {
        a.p_value()
            .total_cmp(&b.p_value())
            .then(b.statistic().total_cmp(&a.statistic()))
    });
    order
}

/// The signatures of several suspects side by side.
pub(crate) fn joined(parts: &[&Suspect]) -> DMatrix<f64> {
    let columns = parts.iter().flat_map(|part| part.signature.column_iter());
    let columns: Vec<DVector<f64>> = columns.map(Matrix::into_owned).collect();
    DMatrix::from_columns(&columns)
}
