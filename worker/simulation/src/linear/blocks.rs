//! Block-tridiagonal matrix of chains of bodies with a common border: storage, factorisation, solution.
//!
//! The border comprises the unknowns that couple to bodies of several chains. It has two parts: first the
//! unknowns of bodies to which more than one chain is attached (the lead), then the unknowns of the structure
//! that carries the chains' other ends (the counted part, whose indices start after the lead).
//!
//! Every chain is eliminated from its free end towards its anchored end, so a border column fills in only
//! from the first block that couples to it, or to a border column behind it. Cost O(blocks).
use super::block::{MatrixBlock, invert, product};
use super::chains::{alternate, interleave_chains, spans};
use super::entry::MatrixEntry;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Error: a pivot is zero or not finite, so the matrix is singular or holds a value that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SingularPivot {
    /// Index of the unknown with the singular pivot, among all unknowns of the matrix.
    pub unknown: usize,
}

/// Square matrix of `blocks * N + border` unknowns: first the blocks of all chains, one chain after the
/// other, then the border (unknowns that couple to several chains).
#[derive(Clone, Debug)]
pub struct Blocks<const N: usize> {
    pub(super) chains: Vec<usize>,
    /// Number of border unknowns; the first `lead` of them belong to bodies shared by several chains.
    pub(super) border: usize,
    lead: usize,
    pub(super) diagonal: Vec<MatrixBlock<N>>,
    /// Coupling of block i (row) with block i + 1 (column).
    pub(super) upper: Vec<MatrixBlock<N>>,
    /// Coupling of block i + 1 (row) with block i (column).
    pub(super) lower: Vec<MatrixBlock<N>>,
    /// Matrix values in the rows of the blocks and the columns of the border, column by column: N values for
    /// each block.
    pub(super) right: Vec<[f64; N]>,
    /// Matrix values in the rows of the border and the columns of the blocks, row by row: N values for each
    /// block.
    pub(super) bottom: Vec<[f64; N]>,
    /// Matrix values in rows and columns of the border, `border * border`, column-major.
    pub(super) corner: Vec<f64>,
    /// For each block, one more than the highest index of a border unknown that may couple to it.
    pub(super) touches: Vec<usize>,
    /// For each chain, one after the other, and each border unknown: first block of the chain whose coupling
    /// with the unknown the factorisation fills in, because it or a block before it couples to this unknown or
    /// to one behind it in the border; the end of the chain if there is none.
    filled: Vec<usize>,
    corner_pivots: Vec<usize>,
}

impl<const N: usize> Blocks<N> {
    /// Creates an empty matrix for chains of the given numbers of blocks. The border has `lead` unknowns of
    /// bodies shared by several chains, then `counted` unknowns of the structure that carries the chains.
    pub fn new(chains: &[usize], [lead, counted]: [usize; 2]) -> Self {
        let blocks: usize = chains.iter().sum();
        let border = lead + counted;
        Self {
            chains: chains.to_vec(),
            border,
            lead,
            diagonal: vec![MatrixBlock::zeros(); blocks],
            upper: vec![MatrixBlock::zeros(); blocks],
            lower: vec![MatrixBlock::zeros(); blocks],
            right: vec![[0.0; N]; blocks * border],
            bottom: vec![[0.0; N]; blocks * border],
            corner: vec![0.0; border * border],
            touches: vec![0; blocks],
            filled: vec![0; chains.len() * border],
            corner_pivots: vec![0; border],
        }
    }

    /// Returns the number of unknowns of the matrix.
    pub fn len(&self) -> usize {
        self.diagonal.len() * N + self.border
    }

    /// Returns whether the matrix has no unknowns.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the number of border unknowns after the leading ones, which belong to bodies shared by several
    /// chains.
    pub const fn border(&self) -> usize {
        self.border - self.lead
    }

    /// Sets all values of the matrix to zero.
    pub fn clear(&mut self) {
        self.diagonal.fill(MatrixBlock::zeros());
        self.upper.fill(MatrixBlock::zeros());
        self.lower.fill(MatrixBlock::zeros());
        self.corner.fill(0.0);
        self.right.fill([0.0; N]);
        self.bottom.fill([0.0; N]);
        self.touches.fill(0);
    }

    /// Returns the index, in `right` and `bottom`, of the coupling of block `b` with border unknown `k`.
    #[inline]
    const fn at(&self, b: usize, k: usize) -> usize {
        k * self.touches.len() + b
    }

    /// Returns the diagonal block of the matrix with the given index, for writing.
    #[inline]
    pub fn diagonal_mut(&mut self, block: usize) -> &mut MatrixBlock<N> {
        &mut self.diagonal[block]
    }

    /// Returns the two couplings of `block` with the next block of its chain: rows of `block` with columns of
    /// the next one, and rows of the next one with columns of `block`.
    #[inline]
    pub fn coupling_mut(&mut self, block: usize) -> (&mut MatrixBlock<N>, &mut MatrixBlock<N>) {
        (&mut self.upper[block], &mut self.lower[block])
    }

    /// Adds `value` to the matrix at row `row` of `block` and border column `k`; `k` counts from the end of
    /// the lead (the border's first part).
    #[inline]
    pub fn add_right(&mut self, block: usize, row: usize, k: usize, value: f64) {
        let k = self.lead + k;
        self.touches[block] = self.touches[block].max(k + 1);
        let at = self.at(block, k);
        self.right[at][row] += value;
    }

    /// Adds `value` to the matrix at border row `k` and column `column` of `block`; `k` counts from the end
    /// of the lead (the border's first part).
    #[inline]
    pub fn add_bottom(&mut self, block: usize, k: usize, column: usize, value: f64) {
        let k = self.lead + k;
        self.touches[block] = self.touches[block].max(k + 1);
        let at = self.at(block, k);
        self.bottom[at][column] += value;
    }

    /// Adds small matrices of one body: `own` to the given rows and columns of its `block`, `right` to these
    /// rows in the first `reach` border columns after the lead, and `bottom` to these columns in the
    /// corresponding border rows.
    pub(crate) fn add_touching<const R: usize, const B: usize>(
        &mut self,
        block: usize,
        rows: &[usize],
        own: &[[f64; R]; R],
        (right, bottom): (&[[f64; B]; R], &[[f64; B]; R]),
        reach: usize,
    ) {
        let diagonal = &mut self.diagonal[block];
        for (&row, own) in rows.iter().zip(own) {
            for (&column, value) in rows.iter().zip(own) {
                diagonal[(row, column)] += value;
            }
        }
        self.touches[block] = self.touches[block].max(self.lead + reach);
        let (first, blocks) = (self.at(block, self.lead), self.touches.len());
        for (to, from) in [(&mut self.right, right), (&mut self.bottom, bottom)] {
            for k in 0..reach {
                let column = &mut to[first + k * blocks];
                for (&row, from) in rows.iter().zip(from) {
                    column[row] += from[k];
                }
            }
        }
    }

    /// Adds `value` to the matrix at a row and a column of the border, both counted from the end of the lead
    /// (the border's first part).
    #[inline]
    pub fn add_corner(&mut self, row: usize, column: usize, value: f64) {
        self.corner[(self.lead + column) * self.border + self.lead + row] += value;
    }

    /// Adds `value` to the matrix at indices among all unknowns: within a block, between neighbouring blocks,
    /// or in the border.
    ///
    /// # Panics
    /// In debug builds, for blocks that are not neighbours of one chain.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        let base = self.diagonal.len() * N;
        let split = |i: usize| (i / N, i % N);
        match (row < base, column < base) {
            (false, false) => {
                self.corner[(column - base) * self.border + row - base] += value;
            }
            (true, false) => {
                let ((block, row), k) = (split(row), column - base);
                self.touches[block] = self.touches[block].max(k + 1);
                let at = self.at(block, k);
                self.right[at][row] += value;
            }
            (false, true) => {
                let ((block, column), k) = (split(column), row - base);
                self.touches[block] = self.touches[block].max(k + 1);
                let at = self.at(block, k);
                self.bottom[at][column] += value;
            }
            (true, true) => {
                let ((b, r), (c, k)) = (split(row), split(column));
                debug_assert!(b.abs_diff(c) <= 1, "blocks {b} and {c} are no neighbours");
                let block = match c.cmp(&b) {
                    std::cmp::Ordering::Equal => &mut self.diagonal[b],
                    std::cmp::Ordering::Greater => &mut self.upper[b],
                    std::cmp::Ordering::Less => &mut self.lower[c],
                };
                block[(r, k)] += value;
            }
        }
    }

    /// Computes the product `y = A x` with the assembled (not factorised) matrix `A`.
    pub fn multiply(&self, x: &[f64], y: &mut [f64]) {
        y.fill(0.0);
        let base = self.diagonal.len() * N;
        let (parts, _) = x[..base].as_chunks::<N>();
        let (border, x_border) = (self.border, &x[base..]);
        let (out, y_border) = y.split_at_mut(base);
        let (out, _) = out.as_chunks_mut::<N>();
        for Range { start, end } in self.spans() {
            for b in start..end {
                let mut sum = product(&self.diagonal[b], &parts[b]);
                let mut add = |more: [f64; N]| {
                    for (sum, more) in sum.iter_mut().zip(more) {
                        *sum += more;
                    }
                };
                if b + 1 < end {
                    add(product(&self.upper[b], &parts[b + 1]));
                }
                if b > start {
                    add(product(&self.lower[b - 1], &parts[b - 1]));
                }
                for k in 0..border {
                    let at = self.at(b, k);
                    add(self.right[at].map(|x| x * x_border[k]));
                    y_border[k] += dot(&self.bottom[at], &parts[b]);
                }
                out[b] = sum;
            }
        }
        for k in 0..self.border {
            for row in 0..self.border {
                y[base + row] += self.corner[k * self.border + row] * x[base + k];
            }
        }
    }

    /// Factorises the matrix in place; its assembled values are overwritten.
    ///
    /// # Errors
    /// [`SingularPivot`] with the unknown whose pivot vanished.
    pub fn factorize(&mut self) -> Result<(), SingularPivot> {
        self.factorize_by(invert)
    }

    /// Factorises a matrix of planar blocks in place, with closed-form inverses of the blocks: takes half of
    /// the time of [`Self::factorize`] and differs from it in rounding.
    pub(super) fn factorize_closed(&mut self) -> Result<(), SingularPivot> {
        self.factorize_by(|block| {
            *block = block.try_inverse().ok_or(0_usize)?;
            Ok(())
        })
    }

    /// Factorises the matrix in place with the given function for inverting a block; on failure that function
    /// returns the index of the singular column.
    #[inline]
    fn factorize_by(
        &mut self,
        mut invert: impl FnMut(&mut MatrixBlock<N>) -> Result<(), usize>,
    ) -> Result<(), SingularPivot> {
        let mut made = Ok(());
        let (diagonal, upper, lower) = (&mut self.diagonal, &mut self.upper, &self.lower);
        interleave_chains(&self.chains, |_, [first, count], from| {
            let b = first + from;
            if let Err(column) = invert(&mut diagonal[b]) {
                let unknown = b * N + column;
                made = made.and(Err(SingularPivot { unknown }));
                return false;
            }
            if from + 1 < count {
                upper[b] = diagonal[b] * upper[b];
                let fill = lower[b] * upper[b];
                diagonal[b + 1] -= fill;
            }
            from + 1 < count
        });
        made?;
        self.find_filled();
        Arch::new().dispatch(EliminateBorder(self));
        self.factorize_corner()
    }

    /// Finds the first block of each chain whose coupling with each border unknown is filled in.
    fn find_filled(&mut self) {
        let m = self.border;
        for (chain, Range { start, end }) in spans(&self.chains).enumerate() {
            let filled = &mut self.filled[chain * m..(chain + 1) * m];
            filled.fill(end);
            let mut reach = 0;
            for b in start..end {
                let touches = self.touches[b];
                for first in filled.iter_mut().take(touches).skip(reach) {
                    *first = b;
                }
                reach = reach.max(touches);
            }
        }
    }

    /// Eliminates all blocks, whose inverses `D^-1` are already stored, from the border; the couplings `right`
    /// become `D^-1 right`, and the couplings `lower` with the next blocks become `lower D^-1`.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn eliminate_border(&mut self) {
        let (m, blocks) = (self.border, self.touches.len());
        for (chain, Range { start, end }) in spans(&self.chains).enumerate() {
            let filled = &self.filled[chain * m..(chain + 1) * m];
            for b in start..end {
                let last = b + 1 == end;
                if !last {
                    self.lower[b] *= self.diagonal[b];
                }
                let transposed = self.upper[b].transpose();
                for k in (0..m).take_while(|&k| filled[k] <= b) {
                    let at = k * blocks + b;
                    if !last {
                        let handed = product(&self.lower[b], &self.right[at]);
                        subtract(&mut self.right[at + 1], &handed);
                        let handed = product(&transposed, &self.bottom[at]);
                        subtract(&mut self.bottom[at + 1], &handed);
                    }
                    self.right[at] = product(&self.diagonal[b], &self.right[at]);
                }
            }
            for column in 0..m {
                for row in 0..m {
                    let first = filled[row].max(filled[column]);
                    let right =
                        self.right[column * blocks + first..column * blocks + end].as_flattened();
                    let bottom =
                        self.bottom[row * blocks + first..row * blocks + end].as_flattened();
                    self.corner[column * m + row] -= dot(bottom, right);
                }
            }
        }
    }

    fn factorize_corner(&mut self) -> Result<(), SingularPivot> {
        let m = self.border;
        let base = self.diagonal.len() * N;
        let a = &mut self.corner;
        for k in 0..m {
            let best = (k..m)
                .max_by(|&i, &j| {
                    a[k * m + i]
                        .abs()
                        .total_cmp(&a[k * m + j].abs())
                        .then(j.cmp(&i))
                })
                .unwrap_or(k);
            let size = a[k * m + best].abs();
            if !(size > 0.0 && size.is_finite()) {
                return Err(SingularPivot { unknown: base + k });
            }
            self.corner_pivots[k] = best;
            if best != k {
                for column in 0..m {
                    a.swap(column * m + k, column * m + best);
                }
            }
            let inverse = 1.0 / a[k * m + k];
            for i in k + 1..m {
                a[k * m + i] *= inverse;
            }
            for column in k + 1..m {
                let factor = a[column * m + k];
                for i in k + 1..m {
                    a[column * m + i] -= a[k * m + i] * factor;
                }
            }
        }
        Ok(())
    }

    /// Solves the linear system with the factorised matrix, overwriting the right-hand side with the
    /// solution.
    pub fn solve(&self, x: &mut [f64]) {
        Arch::new().dispatch(Solve(self, x));
    }

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn solve_inlined(&self, x: &mut [f64]) {
        let (m, blocks) = (self.border, self.touches.len());
        let (x, border) = x.split_at_mut(blocks * N);
        let (x, _) = x.as_chunks_mut::<N>();
        for [one, other] in self.pairs() {
            let (x, y) = x[one.start..].split_at_mut(one.len());
            let factors = |of: Range<usize>| (&self.diagonal[of.clone()], &self.lower[of]);
            let [one, other] = [(one, x), (other.clone(), &mut y[..other.len()])].map(|(of, x)| {
                let (inverses, couplings) = factors(of);
                inverses.iter().zip(couplings).zip(x)
            });
            alternate(one, other, |((inverse, coupling), x), handed| {
                let mut right = *x;
                subtract(&mut right, handed);
                *handed = product(coupling, &right);
                *x = product(inverse, &right);
            });
        }
        let filled = |chain: usize, k: usize, end: usize| {
            let first = self.filled[chain * m + k];
            (first..end, k * blocks + first..k * blocks + end)
        };
        for (chain, Range { end, .. }) in spans(&self.chains).enumerate() {
            for (k, border) in border.iter_mut().enumerate() {
                let (unknowns, couplings) = filled(chain, k, end);
                let bottom = self.bottom[couplings].as_flattened();
                *border -= dot(bottom, x[unknowns].as_flattened());
            }
        }
        self.solve_corner(border);
        for (chain, Range { end, .. }) in spans(&self.chains).enumerate() {
            for (k, border) in border.iter().enumerate() {
                let (unknowns, couplings) = filled(chain, k, end);
                let right = self.right[couplings].as_flattened();
                for (x, right) in x[unknowns].as_flattened_mut().iter_mut().zip(right) {
                    *x -= border * right;
                }
            }
        }
        for [one, other] in self.pairs() {
            let (x, y) = x[one.start..].split_at_mut(one.len());
            let [one, other] = [(one, x), (other.clone(), &mut y[..other.len()])]
                .map(|(of, x)| self.upper[of].iter().zip(x).rev());
            // the last block has no next one
            alternate(one, other, |(coupling, x), next| {
                subtract(x, &product(coupling, next));
                *next = *x;
            });
        }
    }

    /// Iterates over the ranges of blocks of the chains in pairs; an odd chain is paired with an empty range.
    fn pairs(&self) -> impl Iterator<Item = [Range<usize>; 2]> + '_ {
        let mut spans = self.spans();
        std::iter::from_fn(move || Some([spans.next()?, spans.next().unwrap_or(0..0)]))
    }

    /// Iterates over the ranges of blocks of the chains.
    pub(super) fn spans(&self) -> impl Iterator<Item = Range<usize>> + '_ {
        spans(&self.chains)
    }

    /// Returns the number of leading border unknowns whose coupling with block `b` of a chain the factorisation
    /// fills in.
    pub(super) fn filled(&self, chain: usize, b: usize) -> usize {
        let filled = &self.filled[chain * self.border..(chain + 1) * self.border];
        filled.iter().take_while(|&&first| first <= b).count()
    }

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub(super) fn solve_corner<T: MatrixEntry>(&self, x: &mut [T]) {
        let m = self.border;
        for k in 0..m {
            x.swap(k, self.corner_pivots[k]);
        }
        for k in 0..m {
            for i in k + 1..m {
                let known = x[k] * self.corner[k * m + i];
                x[i] -= known;
            }
        }
        for k in (0..m).rev() {
            x[k] = x[k] / self.corner[k * m + k];
            for i in 0..k {
                let known = x[k] * self.corner[k * m + i];
                x[i] -= known;
            }
        }
    }
}

/// Elimination of all blocks of a matrix from its border, compiled for each set of instructions.
struct EliminateBorder<'a, const N: usize>(&'a mut Blocks<N>);

impl<const N: usize> WithSimd for EliminateBorder<'_, N> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.eliminate_border();
    }
}

/// Solution with a factorised matrix, compiled for each set of instructions.
struct Solve<'a, const N: usize>(&'a Blocks<N>, &'a mut [f64]);

impl<const N: usize> WithSimd for Solve<'_, N> {
    type Output = ();

    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.0.solve_inlined(self.1);
    }
}

/// Subtracts the vector `x` from `y`.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn subtract<const N: usize>(y: &mut [f64; N], x: &[f64; N]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y -= x;
    }
}

/// Returns the product of two vectors, summed in four parts side by side whatever the processor.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (fours, rest) = a.as_chunks::<4>();
    let (others, other_rest) = b.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (a, b) in fours.iter().zip(others) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest = rest.iter().zip(other_rest).map(|(a, b)| a * b);
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest.sum::<f64>()
}

#[cfg(test)]
mod tests;
