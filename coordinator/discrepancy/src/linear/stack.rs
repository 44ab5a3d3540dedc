//! Records side by side: their Jacobians, one on top of another.
use nalgebra::DMatrix;

/// One matrix on top of another of as many columns.
pub(crate) fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = above.nrows() + below.nrows();
    let mut both = above.clone().resize_vertically(rows, 0.0);
    both.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    both
}
