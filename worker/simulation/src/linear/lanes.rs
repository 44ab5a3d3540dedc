//! Many right-hand sides side by side: what is done for one vector of unknowns, done for several.
//!
//! A factor is read once for several columns, and what waits for itself along a chain in one column waits
//! no longer in several. No lane knows of its neighbours: a column has the same bits whatever stands
//! beside it.
use super::block::Block;
use super::blocks::Blocks;
use super::bordered::Bordered;
use super::entry::Lanes;

/// The entries of one block of unknowns.
type Part<const N: usize> = [Lanes; N];

/// `y -= A x`.
#[inline(always)]
fn subtract_product<const N: usize>(a: &Block<N>, x: &Part<N>, y: &mut Part<N>) {
    for (k, x) in x.iter().enumerate() {
        for (i, y) in y.iter_mut().enumerate() {
            *y -= *x * a[(i, k)];
        }
    }
}

/// `A x`.
#[inline(always)]
fn product<const N: usize>(a: &Block<N>, x: &Part<N>) -> Part<N> {
    let mut y = [Lanes::default(); N];
    for (k, x) in x.iter().enumerate() {
        for (i, y) in y.iter_mut().enumerate() {
            *y += *x * a[(i, k)];
        }
    }
    y
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "what is done for many columns is a file of its own"
)]
impl<const N: usize> Blocks<N> {
    /// [`Blocks::solve`] for `LANES` columns.
    #[inline(always)]
    pub fn solve_lanes(&self, x: &mut [Lanes]) {
        let m = self.border;
        let (blocks, border) = x.split_at_mut(self.diagonal.len() * N);
        let (blocks, _) = blocks.as_chunks_mut::<N>();
        for [first, count] in self.spans() {
            let mut carried = [Lanes::default(); N];
            for b in first..first + count {
                let mut right = blocks[b];
                for (right, carried) in right.iter_mut().zip(carried) {
                    *right -= carried;
                }
                let y = product(&self.diagonal[b], &right);
                blocks[b] = y;
                for (k, x) in border[..self.filled[b]].iter_mut().enumerate() {
                    for (i, y) in y.iter().enumerate() {
                        *x -= *y * self.bottom[b * m + k][i];
                    }
                }
                carried = product(&self.lower[b], &y);
            }
        }
        self.solve_corner(border);
        for [first, count] in self.spans() {
            let mut next = [Lanes::default(); N];
            for b in (first..first + count).rev() {
                let mut y = blocks[b];
                subtract_product(&self.upper[b], &next, &mut y);
                for (k, x) in border[..self.filled[b]].iter().enumerate() {
                    for (i, y) in y.iter_mut().enumerate() {
                        *y -= *x * self.right[b * m + k][i];
                    }
                }
                blocks[b] = y;
                next = y;
            }
        }
    }

    /// `y -= A x` of the assembled (not factorised) matrix for `LANES` columns.
    #[inline(always)]
    pub fn subtract_product_lanes(&self, x: &[Lanes], y: &mut [Lanes]) {
        let m = self.border;
        let base = self.diagonal.len() * N;
        let (blocks, edge) = x.split_at(base);
        let (blocks, _) = blocks.as_chunks::<N>();
        let (out, out_edge) = y.split_at_mut(base);
        let (out, _) = out.as_chunks_mut::<N>();
        for [first, count] in self.spans() {
            for b in first..first + count {
                let mut y = out[b];
                subtract_product(&self.diagonal[b], &blocks[b], &mut y);
                if b + 1 < first + count {
                    subtract_product(&self.upper[b], &blocks[b + 1], &mut y);
                }
                if b > first {
                    subtract_product(&self.lower[b - 1], &blocks[b - 1], &mut y);
                }
                for k in 0..self.touches[b] {
                    for i in 0..N {
                        y[i] -= edge[k] * self.right[b * m + k][i];
                        out_edge[k] -= blocks[b][i] * self.bottom[b * m + k][i];
                    }
                }
                out[b] = y;
            }
        }
        for (k, x) in edge.iter().enumerate() {
            for (row, y) in out_edge.iter_mut().enumerate() {
                *y -= *x * self.corner[k * m + row];
            }
        }
    }

    /// First block and length of every chain.
    #[inline(always)]
    fn spans(&self) -> impl Iterator<Item = [usize; 2]> + '_ {
        self.chains.iter().scan(0, |first, &count| {
            let span = [*first, count];
            *first += count;
            Some(span)
        })
    }
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "what is done for many columns is a file of its own"
)]
impl Bordered {
    /// [`Bordered::solve`] for `LANES` columns.
    #[inline(always)]
    pub fn solve_lanes(&self, x: &mut [Lanes]) {
        match self {
            Self::Plane(blocks) => blocks.solve_lanes(x),
            Self::Space(blocks) => blocks.solve_lanes(x),
        }
    }

    /// `y -= A x` of the assembled matrix for `LANES` columns.
    #[inline(always)]
    pub fn subtract_product_lanes(&self, x: &[Lanes], y: &mut [Lanes]) {
        match self {
            Self::Plane(blocks) => blocks.subtract_product_lanes(x, y),
            Self::Space(blocks) => blocks.subtract_product_lanes(x, y),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear::LANES;

    /// What is done side by side is done as one by one.
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
        let mut products = vec![Lanes::default(); n];
        a.subtract_product_lanes(&lanes, &mut products);
        let mut factor = a.clone();
        factor.factorize().unwrap();
        let mut solved = lanes;
        factor.solve_lanes(&mut solved);
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
