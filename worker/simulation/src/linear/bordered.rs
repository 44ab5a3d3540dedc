//! One matrix for bodies in the plane or in space: chains of three- or six-wide blocks with a border.
use super::{BLOCK, Block, Blocks, SingularPivot};

/// Chains of blocks with a common border, of one of two widths.
#[derive(Clone, Debug)]
pub enum Bordered {
    /// Three unknowns per body.
    Plane(Blocks<3>),
    /// Six unknowns per body.
    Space(Blocks<BLOCK>),
}

/// Calls the same method on whichever width there is.
macro_rules! either {
    ($self:expr, $blocks:ident => $call:expr) => {
        match $self {
            Bordered::Plane($blocks) => $call,
            Bordered::Space($blocks) => $call,
        }
    };
}

impl Bordered {
    /// An empty matrix of three-wide blocks for chains of the given numbers of blocks; of the border
    /// so many unknowns are in the lead, so many counted.
    pub fn plane(chains: &[usize], border: [usize; 2]) -> Self {
        Self::Plane(Blocks::new(chains, border))
    }

    /// The same of six-wide blocks.
    pub fn space(chains: &[usize], border: [usize; 2]) -> Self {
        Self::Space(Blocks::new(chains, border))
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        either!(self, blocks => blocks.len())
    }

    /// Whether there are no unknowns.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Counted unknowns of the border.
    pub const fn border(&self) -> usize {
        either!(self, blocks => blocks.border())
    }

    /// Sets every entry to zero.
    pub fn clear(&mut self) {
        either!(self, blocks => blocks.clear());
    }

    /// Adds `value` to a diagonal block.
    #[inline]
    pub fn add_diagonal(&mut self, block: usize, row: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.diagonal_mut(block)[(row, column)] += value);
    }

    /// Makes every unknown of `block` but the first one its own: `1` on the diagonal.
    pub fn lock_rest(&mut self, block: usize) {
        fn lock<const N: usize>(block: &mut Block<N>) {
            for k in 1..N {
                block[(k, k)] = 1.0;
            }
        }
        either!(self, blocks => lock(blocks.diagonal_mut(block)));
    }

    /// Adds `value` to row `row` of `block`, counted column `k` of the border.
    #[inline]
    pub fn add_right(&mut self, block: usize, row: usize, k: usize, value: f64) {
        either!(self, blocks => blocks.add_right(block, row, k, value));
    }

    /// Adds `value` to counted row `k` of the border, column `column` of `block`.
    #[inline]
    pub fn add_bottom(&mut self, block: usize, k: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.add_bottom(block, k, column, value));
    }

    /// Adds `value` within the counted border.
    #[inline]
    pub fn add_corner(&mut self, row: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.add_corner(row, column, value));
    }

    /// Adds `value` at any place of the shape: within a block, between neighbours, in the border.
    ///
    /// # Panics
    /// In debug builds, between blocks that are not neighbours of one chain.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        either!(self, blocks => blocks.add(row, column, value));
    }

    /// `A x` of the assembled (not factorised) matrix.
    pub fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; self.len()];
        self.multiply(x, &mut y);
        y
    }

    /// `y = A x` of the assembled (not factorised) matrix.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        either!(self, blocks => blocks.multiply(x, y));
    }

    /// Factorises in place; the assembled entries are lost.
    ///
    /// # Errors
    /// [`SingularPivot`] with the unknown whose pivot vanished.
    pub fn factorize(&mut self) -> Result<(), SingularPivot> {
        either!(self, blocks => blocks.factorize())
    }

    /// The same with inverses of blocks in the plane in closed form: other bits in less time.
    ///
    /// # Errors
    /// [`SingularPivot`] with an unknown of the block that is singular.
    pub(crate) fn factorize_closed(&mut self) -> Result<(), SingularPivot> {
        either!(self, blocks => blocks.factorize_closed())
    }

    /// Solves in place with the factorised matrix.
    pub fn solve(&self, x: &mut [f64]) {
        either!(self, blocks => blocks.solve(x));
    }
}
