//! Sparse Cholesky factorisation with bit-identical results on every processor.
//!
//! Libraries choose their instructions by the processor, and a fused multiply-add rounds once where two
//! instructions round twice. The numeric factorisation is therefore implemented here, in plain loops with a
//! fixed order of summation: left-looking, supernode by supernode, with products in register tiles.
use super::{assembly::Symmetric, elimination::Elimination, error::ReductionError};
use std::cmp::Ordering;

/// Number of rows and of columns of a register tile, the unit in which matrix products are computed.
const TILE: usize = 4;
/// Number of columns of a supernode's panel that are eliminated before the rest of the panel is updated.
const BLOCK: usize = 32;
/// Smallest acceptable ratio of a pivot to its original diagonal entry; below it the matrix counts as
/// singular.
const LEAST_PIVOT: f64 = 1e-12;

/// Cholesky factor of a positive definite matrix.
#[derive(Debug)]
pub(super) struct Factor {
    /// Elimination order: index of the unknown eliminated at each step; length n.
    order: Vec<usize>,
    shape: Shape,
    /// Values of the Cholesky factor, supernode by supernode and column by column; values above the diagonal
    /// are zero.
    values: Vec<f64>,
}

/// Sparsity structure of a Cholesky factor with s supernodes.
#[derive(Debug)]
struct Shape {
    /// First column of each supernode, followed by the number of columns; length s + 1.
    columns: Vec<usize>,
    /// Index in `rows` where each supernode's row indices start, followed by the total number of them; length
    /// s + 1.
    row_starts: Vec<usize>,
    /// Row indices of each supernode below its own columns, ascending, supernode after supernode.
    rows: Vec<usize>,
    /// Index in the factor's values where each supernode's values start, followed by their total number;
    /// length s + 1.
    value_starts: Vec<usize>,
}

impl Shape {
    const fn len(&self) -> usize {
        self.columns.len() - 1
    }

    fn width(&self, node: usize) -> usize {
        self.columns[node + 1] - self.columns[node]
    }

    fn rows(&self, node: usize) -> &[usize] {
        &self.rows[self.row_starts[node]..self.row_starts[node + 1]]
    }

    fn height(&self, node: usize) -> usize {
        self.width(node) + self.rows(node).len()
    }

    fn panel<'a>(&self, values: &'a [f64], node: usize) -> &'a [f64] {
        &values[self.value_starts[node]..self.value_starts[node + 1]]
    }

    /// Returns for every column of the factor the index of its supernode; length n.
    fn owners(&self) -> Vec<usize> {
        let owned = (0..self.len()).map(|node| std::iter::repeat_n(node, self.width(node)));
        owned.flatten().collect()
    }
}

impl Factor {
    /// Factorises a matrix with a fill-reducing elimination order.
    ///
    /// # Errors
    /// [`ReductionError::NotPositiveDefinite`] if the matrix is not positive definite, [`ReductionError::TooLarge`] if
    /// its factor does not fit into memory.
    pub(super) fn new(matrix: &Symmetric) -> Result<Self, ReductionError> {
        let too_large = ReductionError::TooLarge {
            unknowns: matrix.len(),
        };
        let Elimination {
            order,
            columns,
            rows,
        } = Elimination::new(matrix).ok_or(too_large.clone())?;
        let (mut row_starts, mut value_starts) = (vec![0], vec![0]);
        let mut size: usize = 0;
        for (ends, rows) in columns.windows(2).zip(&rows) {
            row_starts.push(row_starts[row_starts.len() - 1] + rows.len());
            let width = ends[1] - ends[0];
            let panel = width.checked_mul(width + rows.len());
            size = panel
                .and_then(|panel| size.checked_add(panel))
                .ok_or(too_large.clone())?;
            value_starts.push(size);
        }
        let mut values = Vec::new();
        values.try_reserve_exact(size).map_err(|_| too_large)?;
        values.resize(size, 0.0);
        let shape = Shape {
            columns,
            row_starts,
            rows: rows.concat(),
            value_starts,
        };
        let mut factor = Self {
            order,
            shape,
            values,
        };
        factor.scatter(matrix);
        factor.eliminate()?;
        Ok(factor)
    }

    /// Copies the values of the matrix into the panels (dense column blocks of the supernodes).
    fn scatter(&mut self, matrix: &Symmetric) {
        let Self {
            order,
            shape,
            values,
        } = self;
        let mut places = vec![0; order.len()];
        for (place, &unknown) in order.iter().enumerate() {
            places[unknown] = place;
        }
        let owners = shape.owners();
        for (row, column, value) in matrix.entries() {
            let (row, column) = (places[row], places[column]);
            let (row, column) = (row.max(column), row.min(column));
            let node = owners[column];
            let (first, width) = (shape.columns[node], shape.width(node));
            let line = if row < first + width {
                row - first
            } else {
                width + shape.rows(node).partition_point(|&r| r < row)
            };
            values[shape.value_starts[node] + (column - first) * shape.height(node) + line] = value;
        }
    }

    /// Computes the Cholesky factor in place in the panels, which hold the values of the matrix.
    fn eliminate(&mut self) -> Result<(), ReductionError> {
        let Self { shape, values, .. } = self;
        let owners = shape.owners();
        let least = least_pivots(shape, values);
        // supernodes whose next rows are columns of this one; where those rows begin
        let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); shape.len()];
        let mut next = vec![0; shape.len()];
        let mut lines = vec![0; owners.len()];
        let mut strips = Vec::new();
        for node in 0..shape.len() {
            let (first, width) = (shape.columns[node], shape.width(node));
            let own = first..first + width;
            for (line, row) in own
                .clone()
                .chain(shape.rows(node).iter().copied())
                .enumerate()
            {
                lines[row] = line;
            }
            let (before, rest) = values.split_at_mut(shape.value_starts[node]);
            let panel = &mut rest[..shape.value_starts[node + 1] - shape.value_starts[node]];
            let height = shape.height(node);
            for earlier in std::mem::take(&mut waiting[node]) {
                let rows = &shape.rows(earlier)[next[earlier]..];
                let wide = rows.partition_point(|&row| row < own.end);
                let earlier_height = shape.height(earlier);
                let from = earlier_height - rows.len();
                let source = shape.panel(before, earlier);
                pack(source, earlier_height, from, &mut strips);
                let depth = shape.width(earlier);
                products(&strips, depth, (rows.len(), wide), |row, column, value| {
                    panel[lines[rows[column]] * height + lines[rows[row]]] -= value;
                });
                if let Some(&row) = rows.get(wide) {
                    next[earlier] += wide;
                    waiting[owners[row]].push(earlier);
                }
            }
            factor_panel(panel, &least[own], &mut strips)?;
            if let Some(&row) = shape.rows(node).first() {
                waiting[owners[row]].push(node);
            }
        }
        Ok(())
    }

    /// Solves the linear system, overwriting the right-hand side with the solution.
    pub(super) fn solve(&self, vector: &mut [f64]) {
        let Self {
            order,
            shape,
            values,
        } = self;
        let mut x: Vec<f64> = order.iter().map(|&unknown| vector[unknown]).collect();
        let mut below = Vec::new();
        for node in 0..shape.len() {
            let (rows, height) = (shape.rows(node), shape.height(node));
            let own = &mut x[shape.columns[node]..shape.columns[node + 1]];
            below.clear();
            below.resize(rows.len(), 0.0);
            for (k, column) in shape.panel(values, node).chunks_exact(height).enumerate() {
                let value = own[k] / column[k];
                own[k] = value;
                let (inside, outside) = column.split_at(own.len());
                subtract(&mut own[k + 1..], &inside[k + 1..], value);
                subtract(&mut below, outside, value);
            }
            for (&row, change) in rows.iter().zip(&below) {
                x[row] += change;
            }
        }
        for node in (0..shape.len()).rev() {
            let (rows, height) = (shape.rows(node), shape.height(node));
            below.clear();
            below.extend(rows.iter().map(|&row| x[row]));
            let own = &mut x[shape.columns[node]..shape.columns[node + 1]];
            let columns = shape.panel(values, node).chunks_exact(height);
            for (k, column) in columns.enumerate().rev() {
                let (inside, outside) = column.split_at(own.len());
                let known = dot(&inside[k + 1..], &own[k + 1..]) + dot(outside, &below);
                own[k] = (own[k] - known) / column[k];
            }
        }
        for (&unknown, value) in order.iter().zip(&x) {
            vector[unknown] = *value;
        }
    }
}

/// Copies a panel's rows from row `from` on into strips of [`TILE`] rows, each stored column by column, so
/// that matrix products read them sequentially; the last strip is padded with zeros.
fn pack(panel: &[f64], height: usize, from: usize, strips: &mut Vec<f64>) {
    let depth = panel.len() / height;
    let count = (height - from).div_ceil(TILE);
    strips.clear();
    strips.resize(count * TILE * depth, 0.0);
    for (at, column) in panel.chunks_exact(height).enumerate() {
        for (strip, rows) in column[from..].chunks(TILE).enumerate() {
            let begin = (strip * depth + at) * TILE;
            strips[begin..begin + rows.len()].copy_from_slice(rows);
        }
    }
}

/// Computes the product `R S'` of the packed rows R with the first of them, S, and passes each value on and
/// below the diagonal to `take`, with its row and column; `size` holds the numbers of rows in R and in S.
fn products(
    strips: &[f64],
    depth: usize,
    size: (usize, usize),
    mut take: impl FnMut(usize, usize, f64),
) {
    let (tall, wide) = size;
    let strips: Vec<&[f64]> = strips.chunks_exact(TILE * depth).collect();
    for (below, right) in strips[..wide.div_ceil(TILE)].iter().enumerate() {
        for (down, left) in strips.iter().enumerate().skip(below) {
            for (j, products) in tile(left, right).iter().enumerate() {
                let column = below * TILE + j;
                for (i, product) in products.iter().enumerate() {
                    let row = down * TILE + i;
                    if column < wide && row < tall && row >= column {
                        take(row, column, *product);
                    }
                }
            }
        }
    }
}

/// Computes the products of every row of strip `left` with every row of strip `right`, summed in order: one
/// tile column per row of `right`.
fn tile(left: &[f64], right: &[f64]) -> [[f64; TILE]; TILE] {
    let mut sums = [[0.0; TILE]; TILE];
    let (left, _) = left.as_chunks::<TILE>();
    let (right, _) = right.as_chunks::<TILE>();
    for (left, right) in left.iter().zip(right) {
        for (sums, b) in sums.iter_mut().zip(right) {
            for (sum, a) in sums.iter_mut().zip(left) {
                *sum += a * b;
            }
        }
    }
    sums
}

/// Computes the smallest acceptable pivot of every column from the unfactorised matrix in the panels; length
/// n.
fn least_pivots(shape: &Shape, values: &[f64]) -> Vec<f64> {
    let mut least = Vec::new();
    for node in 0..shape.len() {
        let columns = shape.panel(values, node).chunks_exact(shape.height(node));
        least.extend(
            columns
                .enumerate()
                .map(|(k, column)| LEAST_PIVOT * column[k]),
        );
    }
    least
}

/// Factorises a panel that has received all updates from earlier supernodes; fails unless every pivot exceeds
/// its limit in `least`.
fn factor_panel(
    panel: &mut [f64],
    least: &[f64],
    strips: &mut Vec<f64>,
) -> Result<(), ReductionError> {
    let width = least.len();
    let height = panel.len() / width;
    for first in (0..width).step_by(BLOCK) {
        let end = (first + BLOCK).min(width);
        for k in first..end {
            let (before, rest) = panel.split_at_mut(k * height);
            let column = &mut rest[k..height];
            for earlier in before[first * height..].chunks_exact(height) {
                subtract(column, &earlier[k..], earlier[k]);
            }
            let pivot = column[0];
            // not a number fails too
            if pivot.partial_cmp(&least[k]) != Some(Ordering::Greater) {
                return Err(ReductionError::NotPositiveDefinite);
            }
            let root = pivot.sqrt();
            for value in column.iter_mut() {
                *value /= root;
            }
        }
        if end < width {
            let block = &panel[first * height..end * height];
            pack(block, height, end, strips);
            let size = (height - end, width - end);
            products(strips, end - first, size, |row, column, value| {
                panel[(end + column) * height + end + row] -= value;
            });
        }
    }
    Ok(())
}

/// Computes `vector -= factor * column`, entry by entry.
fn subtract(vector: &mut [f64], column: &[f64], factor: f64) {
    for (entry, value) in vector.iter_mut().zip(column) {
        *entry -= factor * value;
    }
}

/// Computes the inner product with [`TILE`] parallel partial sums, which are then added in order.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (heads, tail) = a.as_chunks::<TILE>();
    let (others, rest) = b.as_chunks::<TILE>();
    let mut sums = [0.0; TILE];
    for (a, b) in heads.iter().zip(others) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += a * b;
        }
    }
    let last: f64 = tail.iter().zip(rest).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + last
}
