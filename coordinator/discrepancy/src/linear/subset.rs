//! Selection of small subsets of effects that explain a residual together, to first order: every pair and
//! every triple is tried on projected signatures. The proposed subsets are confirmed or rejected by refits.
use crate::linear::tangent::Tangent;
use nalgebra::{DMatrix, DVector, Matrix};

/// Subset of effects, by their indices, with the joint estimate of their sizes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Subset {
    pub(crate) members: Vec<usize>,
    pub(crate) sizes: Vec<f64>,
    /// Decrease of `chi^2` less two per estimated size (Akaike's penalty).
    pub(crate) merit: f64,
}

/// Normal equations of all effects, from which any subset can be estimated.
pub(crate) struct Subsets {
    /// Information matrix `G^T B G` of the signatures of all effects; `gain` is `G^T r`.
    information: DMatrix<f64>,
    gain: DVector<f64>,
    /// Index of the first signature column, and number of columns, of each effect in the normal equations.
    columns: Vec<(usize, usize)>,
    /// Whether the size parameter that belongs to each signature column cannot be negative.
    positive: Vec<bool>,
}

impl Subsets {
    /// Builds the normal equations from the effects' signatures (a column is the change of the whitened
    /// prediction per unit of one size), each with flags for the sizes that cannot be negative.
    pub(crate) fn new(
        residual: &DVector<f64>,
        signatures: &[(&DMatrix<f64>, Vec<bool>)],
        tangent: &Tangent,
    ) -> Self {
        let mut columns = Vec::with_capacity(signatures.len());
        let mut all: Vec<DVector<f64>> = Vec::new();
        let mut positive = Vec::new();
        for (signature, signs) in signatures {
            columns.push((all.len(), signature.ncols()));
            all.extend(signature.column_iter().map(Matrix::into_owned));
            positive.extend(signs.iter().copied());
        }
        let all = if all.is_empty() {
            DMatrix::zeros(residual.len(), 0)
        } else {
            DMatrix::from_columns(&all)
        };
        Self {
            information: all.tr_mul(&tangent.project_columns(&all)),
            gain: all.tr_mul(residual),
            columns,
            positive,
        }
    }

    /// Returns the `kept` subsets of `count` effects with the greatest merit, best first; subsets in which a
    /// size has a sign that is not allowed are left out.
    pub(crate) fn best(&self, count: usize, kept: usize) -> Vec<Subset> {
        let mut all: Vec<Subset> = Vec::new();
        let mut members: Vec<usize> = (0..count).collect();
        if count == 0 || count > self.columns.len() {
            return all;
        }
        loop {
            all.extend(self.judge(&members));
            all.sort_by(|a, b| b.merit.total_cmp(&a.merit));
            all.truncate(kept);
            // the next in order: the last place that can still move does
            let n = self.columns.len();
            let Some(place) = (0..count).rev().find(|&k| members[k] < n - count + k) else {
                return all;
            };
            members[place] += 1;
            for k in place + 1..count {
                members[k] = members[k - 1] + 1;
            }
        }
    }

    /// Returns the joint estimate of the sizes of the effects `members`; `None` where they are linearly
    /// dependent or a size has a sign that is not allowed.
    fn judge(&self, members: &[usize]) -> Option<Subset> {
        let of = |&member: &usize| {
            let (first, count) = self.columns[member];
            first..first + count
        };
        let columns: Vec<usize> = members.iter().flat_map(of).collect();
        let matrix = DMatrix::from_fn(columns.len(), columns.len(), |i, j| {
            let ridge = if i == j { 1.0 + 1e-9 } else { 1.0 };
            ridge * self.information[(columns[i], columns[j])]
        });
        let gain = DVector::from_fn(columns.len(), |i, _| self.gain[columns[i]]);
        let sizes = matrix.cholesky()?.solve(&gain);
        let mut signs = columns.iter().zip(sizes.iter());
        if signs.any(|(&k, size)| self.positive[k] && *size < 0.0) {
            return None;
        }
        Some(Subset {
            members: members.to_vec(),
            merit: gain.dot(&sizes) - 2.0 * columns.len() as f64,
            sizes: sizes.iter().copied().collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use search::least_squares::Linearized;
    use search::random::{Phase, Streams};

    /// Checks that two effects that act together are found, with their sizes, in spite of a third one that
    /// resembles their sum, and that no subset with a negative estimate of a positive size is proposed.
    #[test]
    fn what_acts_together_is_proposed_together() {
        let mut stream = Streams::new(3, 0).at(0, Phase::Initial, 0);
        let entries = 200;
        let mut column = || DMatrix::from_fn(entries, 1, |_, _| stream.normal());
        let mut all: Vec<DMatrix<f64>> = (0..6).map(|_| column()).collect();
        // a third one resembles the sum
        all[5] = &all[1] * 3.0 - &all[4] * 2.0 + &all[5];
        let residual = &all[1] * 3.0 - &all[4] * 2.0;
        let residual = residual.column(0).into_owned();
        let nothing = Linearized {
            x: Vec::new(),
            residual: residual.clone(),
            jacobian: DMatrix::zeros(entries, 0),
        };
        let tangent = Tangent::new(&nothing, &[]);
        let best = |positive: bool, count: usize| {
            let signatures = all
                .iter()
                .map(|one| (one, vec![positive]))
                .collect::<Vec<_>>();
            Subsets::new(&residual, &signatures, &tangent).best(count, 2)
        };
        assert_eq!(best(false, 1)[0].members, [5]);
        let pair = &best(false, 2)[0];
        assert_eq!(pair.members, [1, 4]);
        assert!((pair.sizes[0] - 3.0).abs() < 1e-6 && (pair.sizes[1] + 2.0).abs() < 1e-6);
        assert!(best(true, 2).iter().all(|own| own.members != [1, 4]));
        assert_eq!(best(false, 6).len(), 1);
        assert!(best(false, 7).is_empty() && best(false, 0).is_empty());
    }
}
