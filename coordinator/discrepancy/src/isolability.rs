//! What this record could tell apart, before any verdict: detection limits of single effects, and
//! how far two effects lie apart once recalibration has taken its share.
//!
//! `D_jk^2 = lambda_min(G~_j^T (I - P_G~k) G~_j)` with projected signatures per physical size: two
//! effects of size eta are told apart where `eta^2 D^2 > 11`. An effect is seen from
//! `4.5 / sqrt(lambda_min(G~^T G~))` on. (Eriksson, Frisk, Krysander: distinguishability;
//! Doehler, Mevel, Zhang: min-max test.)
use crate::tangent::Tangent;
use nalgebra::DMatrix;

/// An effect of size 1 is told apart from another where `D^2` exceeds this.
pub const APART: f64 = 11.0;

/// The size from which an effect is seen, in units of its signature's size; infinite if
/// recalibration absorbs it.
pub fn detection_limit(signature: &DMatrix<f64>, tangent: &Tangent) -> f64 {
    let information = signature.tr_mul(&tangent.project_columns(signature));
    let least = information.symmetric_eigenvalues().min();
    if least > 0.0 {
        4.5 / least.sqrt()
    } else {
        f64::INFINITY
    }
}

/// `D_jk^2` for every pair: row j, column k: how much of effect j per unit size no amount of
/// effect k, and no recalibration, explains.
pub fn distances(signatures: &[DMatrix<f64>], tangent: &Tangent) -> DMatrix<f64> {
    let projected: Vec<DMatrix<f64>> = signatures
        .iter()
        .map(|g| tangent.project_columns(g))
        .collect();
    let bases: Vec<DMatrix<f64>> = projected.iter().map(orthonormal).collect();
    DMatrix::from_fn(signatures.len(), signatures.len(), |j, k| {
        let left = &projected[j] - &bases[k] * bases[k].tr_mul(&projected[j]);
        left.tr_mul(&left).symmetric_eigenvalues().min().max(0.0)
    })
}

/// Effects grouped such that members of one group cannot be told apart at size 1; singletons are
/// isolable.
pub fn classes(distances: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let n = distances.nrows();
    let mut group: Vec<usize> = (0..n).collect();
    for j in 0..n {
        for k in 0..j {
            if distances[(j, k)].min(distances[(k, j)]) < APART {
                let (from, to) = (group[j].max(group[k]), group[j].min(group[k]));
                for g in &mut group {
                    if *g == from {
                        *g = to;
                    }
                }
            }
        }
    }
    let mut classes: Vec<Vec<usize>> = Vec::new();
    for first in 0..n {
        let members: Vec<usize> = (0..n).filter(|&i| group[i] == first).collect();
        if !members.is_empty() {
            classes.push(members);
        }
    }
    classes
}

/// Orthonormal basis of the columns' span.
fn orthonormal(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let svd = columns.clone().svd(true, false);
    let largest = svd.singular_values.max();
    let kept: Vec<usize> = (0..svd.singular_values.len())
        .filter(|&i| svd.singular_values[i] > 1e-9 * largest)
        .collect();
    svd.u.map_or_else(
        || DMatrix::zeros(columns.nrows(), 0),
        |u| u.select_columns(&kept),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use search::least_squares::Linearized;

    fn nothing(n: usize) -> Tangent {
        let at = Linearized {
            x: Vec::new(),
            residual: DVector::zeros(n),
            jacobian: DMatrix::zeros(n, 0),
        };
        Tangent::new(&at, &[])
    }

    fn column(values: &[f64]) -> DMatrix<f64> {
        DMatrix::from_column_slice(values.len(), 1, values)
    }

    #[test]
    fn limits_and_distances_follow_the_geometry() {
        let tangent = nothing(3);
        let (a, b) = (column(&[30.0, 0.0, 0.0]), column(&[30.0, 4.0, 0.0]));
        assert!((detection_limit(&a, &tangent) - 0.15).abs() < 1e-12);
        let c = column(&[0.0, 0.0, 5.0]);
        let d = distances(&[a, b, c], &tangent);
        // a's part across b: 30 sin(angle), angle = atan(4/30)
        let sine = 4.0 / (30.0_f64 * 30.0 + 16.0).sqrt();
        assert!((d[(0, 1)] - (30.0 * sine).powi(2)).abs() < 1e-9);
        assert!((d[(1, 0)] - 16.0).abs() < 1e-9);
        assert!((d[(2, 0)] - 25.0).abs() < 1e-9);
        assert_eq!(classes(&d), vec![vec![0], vec![1], vec![2]]);
        let near = distances(
            &[
                column(&[30.0, 0.0, 0.0]),
                column(&[30.0, 3.0, 0.0]),
                column(&[0.0, 0.0, 9.0]),
            ],
            &tangent,
        );
        assert_eq!(classes(&near), vec![vec![0, 1], vec![2]]);
    }
}
