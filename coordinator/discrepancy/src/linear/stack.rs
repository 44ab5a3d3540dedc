//! Stacking of the Jacobians of several records into one matrix.
use nalgebra::DMatrix;

/// Returns the rows of `above` followed by the rows of `below`; both have the same number of columns.
pub(crate) fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = above.nrows() + below.nrows();
    let mut both = above.clone().resize_vertically(rows, 0.0);
    both.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    both
}
