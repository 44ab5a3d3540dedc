//! Dense 6 x 6 blocks: LU with partial pivoting, products.
use nalgebra::{SMatrix, SVector};

/// Width of a block: the six coordinates of a rigid body.
pub const BLOCK: usize = 6;

/// One block, column-major.
pub type Block = SMatrix<f64, BLOCK, BLOCK>;

/// Row exchanges of a factorised block.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pivots([u8; BLOCK]);

/// Factorises in place: unit lower and upper triangle.
///
/// # Errors
/// The column whose pivot vanished or is not finite.
pub(super) fn factorize(a: &mut Block) -> Result<Pivots, usize> {
    let mut pivots = [0_u8; BLOCK];
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
        #[expect(clippy::cast_possible_truncation, reason = "below six")]
        {
            pivots[k] = best as u8;
        }
        if best != k {
            a.swap_rows(k, best);
        }
        let inverse = 1.0 / a[(k, k)];
        for i in k + 1..BLOCK {
            a[(i, k)] *= inverse;
        }
        for j in k + 1..BLOCK {
            let factor = a[(k, j)];
            for i in k + 1..BLOCK {
                a[(i, j)] -= a[(i, k)] * factor;
            }
        }
    }
    Ok(Pivots(pivots))
}

/// Solves in place for one right-hand side.
#[inline]
pub(super) fn solve(a: &Block, pivots: &Pivots, x: &mut [f64; BLOCK]) {
    for k in 0..BLOCK {
        x.swap(k, usize::from(pivots.0[k]));
    }
    for k in 0..BLOCK {
        let value = x[k];
        for i in k + 1..BLOCK {
            x[i] -= a[(i, k)] * value;
        }
    }
    for k in (0..BLOCK).rev() {
        x[k] /= a[(k, k)];
        let value = x[k];
        for i in 0..k {
            x[i] -= a[(i, k)] * value;
        }
    }
}

/// `y -= A x`.
#[inline]
pub(super) fn subtract_product(a: &Block, x: &SVector<f64, BLOCK>, y: &mut SVector<f64, BLOCK>) {
    for k in 0..BLOCK {
        let value = x[k];
        for i in 0..BLOCK {
            y[i] -= a[(i, k)] * value;
        }
    }
}
