//! Dense blocks of three or six rows, one per rigid body: inversion by elimination with partial pivoting, and
//! products.
//!
//! An explicit inverse costs more to compute than triangular factors, but one factorisation serves some
//! twenty solutions, and a product with the inverse is six independent columns where a triangular solution is
//! a chain of dependent operations.
use nalgebra::{SMatrix, SVector};

/// Number of coordinates of a rigid body in space, and width of its block.
pub const BLOCK: usize = 6;

/// Dense block of a matrix, column-major.
pub type MatrixBlock<const N: usize = BLOCK> = SMatrix<f64, N, N>;

/// Section of a vector of unknowns that belongs to one body.
type Column<const N: usize> = SVector<f64, N>;

/// Replaces a block by its inverse (Gauss-Jordan with row exchanges).
///
/// # Errors
/// Index of the column whose pivot is zero or not finite.
pub(super) fn invert<const N: usize>(a: &mut MatrixBlock<N>) -> Result<(), usize> {
    let mut exchanged = [0; N];
    for k in 0..N {
        let mut best = k;
        let mut size = a[(k, k)].abs();
        for i in k + 1..N {
            let candidate = a[(i, k)].abs();
            if candidate > size {
                best = i;
                size = candidate;
            }
        }
        // written so that NaN fails too
        if !(size > 0.0 && size.is_finite()) {
            return Err(k);
        }
        exchanged[k] = best;
        if best != k {
            a.swap_rows(k, best);
        }
        let inverse = 1.0 / a[(k, k)];
        let mut column = a.column(k).into_owned();
        column[k] = -1.0;
        a.set_column(k, &Column::<N>::zeros());
        a[(k, k)] = 1.0;
        for j in 0..N {
            let factor = a[(k, j)] * inverse;
            for i in 0..N {
                a[(i, j)] -= column[i] * factor;
            }
            a[(k, j)] = factor;
        }
    }
    for k in (0..N).rev() {
        a.swap_columns(k, exchanged[k]);
    }
    Ok(())
}

/// Returns the product of a matrix block and a vector.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
pub(super) fn product<const N: usize>(a: &MatrixBlock<N>, x: &[f64; N]) -> [f64; N] {
    let columns = &a.data.0;
    let mut y = columns[0].map(|a| a * x[0]);
    for k in 1..N {
        for i in 0..N {
            y[i] += columns[k][i] * x[k];
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_a_block_that_needs_row_exchanges() {
        let mut a = MatrixBlock::<6>::from_fn(|i, j| {
            ((3 * i + 5 * j) % 7) as f64 - 2.5 + 0.1 * (i * j) as f64
        });
        a[(0, 0)] = 0.0;
        let mut inverse = a;
        invert(&mut inverse).unwrap();
        assert!(
            (a * inverse - MatrixBlock::<6>::identity()).norm() < 1e-12,
            "{}",
            a * inverse
        );
        let mut singular = a;
        singular.set_column(3, &a.column(1).into_owned());
        singular.set_column(1, &Column::<6>::zeros());
        assert_eq!(invert(&mut singular), Err(1));
    }
}
