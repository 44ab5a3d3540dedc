//! Linear solution and matrix product for several right-hand sides (columns) simultaneously, one per SIMD
//! lane.
//!
//! The matrix factor is read once for several columns, and the dependent operations along a chain in one
//! column overlap with those of the other columns. Lanes are independent: a column has the same bits whatever
//! columns are solved with it.
use super::block::MatrixBlock;
use super::blocks::Blocks;
use super::bordered::Bordered;
use super::entry::Lanes;
use pulp::Simd;
use std::ops::Range;

/// Unknowns of one block, in all lanes.
type Part<const N: usize> = [Lanes; N];

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn subtract_product<const N: usize, S: Simd>(
    simd: S,
    a: &MatrixBlock<N>,
    x: &Part<N>,
    y: &mut Part<N>,
) {
    for (x, column) in x.iter().zip(&a.data.0) {
        for (y, a) in y.iter_mut().zip(column) {
            y.subtract_scaled(simd, x, *a);
        }
    }
}

#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn product<const N: usize, S: Simd>(simd: S, a: &MatrixBlock<N>, x: &Part<N>) -> Part<N> {
    let mut y = [Lanes::default(); N];
    for (x, column) in x.iter().zip(&a.data.0) {
        for (y, a) in y.iter_mut().zip(column) {
            y.add_scaled(simd, x, *a);
        }
    }
    y
}

/// Iterates over the first `reach` border columns (or, transposed, border rows) of the matrix at block `b` of
/// `blocks`.
#[expect(
    clippy::inline_always,
    reason = "compiled for each set of instructions"
)]
#[inline(always)]
fn touching<const N: usize>(
    all: &[[f64; N]],
    (b, blocks): (usize, usize),
    reach: usize,
) -> impl Iterator<Item = &[f64; N]> {
    all.iter().skip(b).step_by(blocks).take(reach)
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "what is done for many columns is a file of its own"
)]
impl<const N: usize> Blocks<N> {
    /// Solves the linear system for `LANES` right-hand sides in place, like [`Blocks::solve`].
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn solve_lanes<S: Simd>(&self, simd: S, x: &mut [Lanes]) {
        let m = self.diagonal.len();
        let (blocks, border) = x.split_at_mut(self.diagonal.len() * N);
        let (blocks, _) = blocks.as_chunks_mut::<N>();
        for (chain, Range { start, end }) in self.spans().enumerate() {
            let mut carried = [Lanes::default(); N];
            for b in start..end {
                let mut right = blocks[b];
                for (right, carried) in right.iter_mut().zip(carried) {
                    *right -= carried;
                }
                let y = product(simd, &self.diagonal[b], &right);
                blocks[b] = y;
                let rows = touching(&self.bottom, (b, m), self.filled(chain, b));
                for (x, row) in border.iter_mut().zip(rows) {
                    for (y, a) in y.iter().zip(row) {
                        x.subtract_scaled(simd, y, *a);
                    }
                }
                carried = product(simd, &self.lower[b], &right);
            }
        }
        self.solve_corner(border);
        for (chain, Range { start, end }) in self.spans().enumerate() {
            let mut next = [Lanes::default(); N];
            for b in (start..end).rev() {
                let mut y = blocks[b];
                subtract_product(simd, &self.upper[b], &next, &mut y);
                let columns = touching(&self.right, (b, m), self.filled(chain, b));
                for (x, column) in border.iter().zip(columns) {
                    for (y, a) in y.iter_mut().zip(column) {
                        y.subtract_scaled(simd, x, *a);
                    }
                }
                blocks[b] = y;
                next = y;
            }
        }
    }

    /// Subtracts the product `A x` from `y` with the assembled (not factorised) matrix `A`, for `LANES`
    /// vectors.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn subtract_product_lanes<S: Simd>(&self, simd: S, x: &[Lanes], y: &mut [Lanes]) {
        let m = self.diagonal.len();
        let base = self.diagonal.len() * N;
        let (blocks, edge) = x.split_at(base);
        let (blocks, _) = blocks.as_chunks::<N>();
        let (out, out_edge) = y.split_at_mut(base);
        let (out, _) = out.as_chunks_mut::<N>();
        for Range { start, end } in self.spans() {
            for b in start..end {
                let mut y = out[b];
                let x = &blocks[b];
                subtract_product(simd, &self.diagonal[b], x, &mut y);
                if b + 1 < end {
                    subtract_product(simd, &self.upper[b], &blocks[b + 1], &mut y);
                }
                if b > start {
                    subtract_product(simd, &self.lower[b - 1], &blocks[b - 1], &mut y);
                }
                let columns = touching(&self.right, (b, m), self.touches[b]);
                for (x, column) in edge.iter().zip(columns) {
                    for (y, a) in y.iter_mut().zip(column) {
                        y.subtract_scaled(simd, x, *a);
                    }
                }
                let rows = touching(&self.bottom, (b, m), self.touches[b]);
                for (y, row) in out_edge.iter_mut().zip(rows) {
                    for (x, a) in x.iter().zip(row) {
                        y.subtract_scaled(simd, x, *a);
                    }
                }
                out[b] = y;
            }
        }
        for (k, x) in edge.iter().enumerate() {
            for (row, y) in out_edge.iter_mut().enumerate() {
                y.subtract_scaled(simd, x, self.corner[k * self.border + row]);
            }
        }
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "what is done for many columns is a file of its own"
)]
impl Bordered {
    /// Solves the linear system for `LANES` right-hand sides in place, like [`Bordered::solve`].
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn solve_lanes<S: Simd>(&self, simd: S, x: &mut [Lanes]) {
        match self {
            Self::Plane(blocks) => blocks.solve_lanes(simd, x),
            Self::Space(blocks) => blocks.solve_lanes(simd, x),
        }
    }

    /// Subtracts the product `A x` from `y` with the assembled (not factorised) matrix `A`, for `LANES`
    /// vectors.
    #[expect(
        clippy::inline_always,
        reason = "compiled for each set of instructions"
    )]
    #[inline(always)]
    pub fn subtract_product_lanes<S: Simd>(&self, simd: S, x: &[Lanes], y: &mut [Lanes]) {
        match self {
            Self::Plane(blocks) => blocks.subtract_product_lanes(simd, x, y),
            Self::Space(blocks) => blocks.subtract_product_lanes(simd, x, y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::LANES;
    use pulp::{Arch, Scalar, WithSimd};

    /// Test computation that is run for each SIMD width: product with an assembled matrix, and solution with
    /// its factorisation.
    struct Work<'a>([&'a Bordered; 2], &'a [Lanes]);

    impl WithSimd for Work<'_> {
        type Output = [Vec<Lanes>; 2];

        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let Self([matrix, factor], x) = self;
            let (mut product, mut solved) = (vec![Lanes::default(); x.len()], x.to_vec());
            matrix.subtract_product_lanes(simd, x, &mut product);
            factor.solve_lanes(simd, &mut solved);
            [product, solved]
        }
    }

    /// Checks that solution and product in lanes equal those of single right-hand sides, and have the same
    /// bits for every SIMD width.
    #[test]
    fn columns_are_solved_and_multiplied_as_one_by_one() {
        let mut a = Bordered::plane(&[3, 5], [1, 2]);
        let n = a.len();
        let wave = |k: usize| 0.3 * libm::sin(1.0 + 0.7 * k as f64);
        for i in 0..n {
            a.add(i, i, 3.0 + wave(i));
            for k in n - 3..n {
                a.add(i, k, wave(3 * i + k));
                a.add(k, i, wave(i + 5 * k));
            }
        }
        for i in (0..6).chain(9..21) {
            a.add(i, i + 3, wave(7 * i));
            a.add(i + 3, i, wave(11 * i));
        }
        let columns: Vec<Vec<f64>> = (0..LANES)
            .map(|lane| (0..n).map(|i| wave(i * (lane + 2))).collect())
            .collect();
        let lanes: Vec<Lanes> = (0..n)
            .map(|i| Lanes(std::array::from_fn(|lane| columns[lane][i])))
            .collect();
        let mut factor = a.clone();
        factor.factorize().unwrap();
        let work = || Work([&a, &factor], &lanes);
        let [products, solved] = work().with_simd(Scalar);
        let bits = |[products, solved]: &[Vec<Lanes>; 2]| -> Vec<u64> {
            let all = products.iter().chain(solved);
            all.flat_map(|x| x.0.map(f64::to_bits)).collect()
        };
        let both = [products, solved];
        assert_eq!(bits(&both), bits(&Arch::new().dispatch(work())));
        let [products, solved] = both;
        for (lane, column) in columns.iter().enumerate() {
            let product = a.product(column);
            let mut x = column.clone();
            factor.solve(&mut x);
            for i in 0..n {
                assert!((products[i].0[lane] + product[i]).abs() < 1e-13);
                assert!((solved[i].0[lane] - x[i]).abs() < 1e-12);
            }
        }
    }
}
