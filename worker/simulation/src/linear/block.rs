//! Dense 6 x 6 blocks: inversion by elimination with partial pivoting, products.
//!
//! A factorisation is used for some twenty solutions, and a product with an explicit inverse is six
//! independent columns where a triangular solution is a chain: it is worth its making.
use nalgebra::{SMatrix, SVector};

/// Width of a block: the six coordinates of a rigid body.
pub const BLOCK: usize = 6;

/// One block, column-major.
pub type Block = SMatrix<f64, BLOCK, BLOCK>;

/// Six entries of a vector of unknowns.
pub(super) type Column = SVector<f64, BLOCK>;

/// Replaces a block by its inverse (Gauss-Jordan with row exchanges).
///
/// # Errors
/// The column whose pivot vanished or is not finite.
pub(super) fn invert(a: &mut Block) -> Result<(), usize> {
    let mut exchanged = [0; BLOCK];
    for k in 0..BLOCK {
        let mut best = k;
        let mut size = a[(k, k)].abs();
        for i in k + 1..BLOCK {
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
        a.set_column(k, &Column::zeros());
        a[(k, k)] = 1.0;
        for j in 0..BLOCK {
            let factor = a[(k, j)] * inverse;
            for i in 0..BLOCK {
                a[(i, j)] -= column[i] * factor;
            }
            a[(k, j)] = factor;
        }
    }
    for k in (0..BLOCK).rev() {
        a.swap_columns(k, exchanged[k]);
    }
    Ok(())
}

/// `A x`.
#[inline]
pub(super) fn product(a: &Block, x: &Column) -> Column {
    let mut y = Column::zeros();
    for k in 0..BLOCK {
        let value = x[k];
        for i in 0..BLOCK {
            y[i] += a[(i, k)] * value;
        }
    }
    y
}

/// `y -= A x`.
#[inline]
pub(super) fn subtract_product(a: &Block, x: &Column, y: &mut Column) {
    for k in 0..BLOCK {
        let value = x[k];
        for i in 0..BLOCK {
            y[i] -= a[(i, k)] * value;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inverse_undoes_a_block_that_needs_row_exchanges() {
        let mut a =
            Block::from_fn(|i, j| ((3 * i + 5 * j) % 7) as f64 - 2.5 + 0.1 * (i * j) as f64);
        a[(0, 0)] = 0.0;
        let mut inverse = a;
        invert(&mut inverse).unwrap();
        assert!(
            (a * inverse - Block::identity()).norm() < 1e-12,
            "{}",
            a * inverse
        );
        let mut singular = a;
        singular.set_column(3, &a.column(1).into_owned());
        singular.set_column(1, &Column::zeros());
        assert_eq!(invert(&mut singular), Err(1));
    }
}
