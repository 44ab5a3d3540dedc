//! Bordered matrix for bodies in the plane or in space: chains of blocks of width three or six with a border.
use super::{BLOCK, Blocks, MatrixBlock, SingularPivot};

/// Bordered block-tridiagonal system matrix for bodies in the plane (three unknowns each) or in space (six).
#[derive(Clone, Debug)]
pub enum Bordered {
    /// Matrix with three unknowns per body.
    Plane(Blocks<3>),
    /// Matrix with six unknowns per body.
    Space(Blocks<BLOCK>),
}

/// Calls the same method on the contained matrix, whichever its block width.
macro_rules! either {
    ($self:expr, $blocks:ident => $call:expr) => {
        match $self {
            Bordered::Plane($blocks) => $call,
            Bordered::Space($blocks) => $call,
        }
    };
}

impl Bordered {
    /// Creates an empty matrix of blocks of width three for chains of the given numbers of blocks; `border`
    /// holds the number of leading border unknowns (bodies shared by several chains) and of the others.
    pub fn plane(chains: &[usize], border: [usize; 2]) -> Self {
        Self::Plane(Blocks::new(chains, border))
    }

    /// Creates an empty matrix of blocks of width six; arguments as for [`Self::plane`].
    pub fn space(chains: &[usize], border: [usize; 2]) -> Self {
        Self::Space(Blocks::new(chains, border))
    }

    /// Returns the number of unknowns of the matrix.
    pub fn len(&self) -> usize {
        either!(self, blocks => blocks.len())
    }

    /// Returns whether the matrix has no unknowns.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of border unknowns after the leading ones, which belong to bodies shared by several
    /// chains.
    pub const fn border(&self) -> usize {
        either!(self, blocks => blocks.border())
    }

    /// Sets all values of the matrix to zero.
    pub fn clear(&mut self) {
        either!(self, blocks => blocks.clear());
    }

    /// Adds `value` to the matrix at `row` and `column` of a diagonal block.
    #[inline]
    pub fn add_diagonal(&mut self, block: usize, row: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.diagonal_mut(block)[(row, column)] += value);
    }

    /// Decouples all unknowns of `block` but the first by setting their diagonal entries to 1.
    pub fn lock_rest(&mut self, block: usize) {
        fn lock<const N: usize>(block: &mut MatrixBlock<N>) {
            for k in 1..N {
                block[(k, k)] = 1.0;
            }
        }
        either!(self, blocks => lock(blocks.diagonal_mut(block)));
    }

    /// Adds `value` to the matrix at row `row` of `block` and border column `k`; `k` counts from the end of
    /// the lead (the border's first part).
    #[inline]
    pub fn add_right(&mut self, block: usize, row: usize, k: usize, value: f64) {
        either!(self, blocks => blocks.add_right(block, row, k, value));
    }

    /// Adds `value` to the matrix at border row `k` and column `column` of `block`; `k` counts from the end
    /// of the lead (the border's first part).
    #[inline]
    pub fn add_bottom(&mut self, block: usize, k: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.add_bottom(block, k, column, value));
    }

    /// Adds `value` to the matrix at a row and a column of the border, both counted from the end of the lead
    /// (the border's first part).
    #[inline]
    pub fn add_corner(&mut self, row: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.add_corner(row, column, value));
    }

    /// Adds `value` to the matrix at indices among all unknowns: within a block, between neighbouring blocks,
    /// or in the border.
    ///
    /// # Panics
    /// In debug builds, for blocks that are not neighbours of one chain.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.add(row, column, value));
    }

    /// Returns the product `A x` with the assembled (not factorised) matrix `A`.
    pub fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.len()];
        self.multiply(x, &mut y);
        y
    }

    /// Computes the product `y = A x` with the assembled (not factorised) matrix `A`.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        either!(self, blocks => blocks.multiply(x, y));
    }

    /// Factorises the matrix in place; its assembled values are overwritten.
    ///
    /// # Errors
    /// [`SingularPivot`] with the unknown whose pivot vanished.
    pub fn factorize(&mut self) -> Result<(), SingularPivot> {
        either!(self, blocks => blocks.factorize())
    }

    /// Factorises the matrix in place with closed-form inverses of planar blocks: faster than
    /// [`Self::factorize`] and different from it in rounding.
    ///
    /// # Errors
    /// [`SingularPivot`] with an unknown of the block that is singular.
    pub(crate) fn factorize_closed(&mut self) -> Result<(), SingularPivot> {
        either!(self, blocks => blocks.factorize_closed())
    }

    /// Solves the linear system with the factorised matrix, overwriting the right-hand side with the
    /// solution.
    pub fn solve(&self, x: &mut [f64]) {
        either!(self, blocks => blocks.solve(x));
    }
}
