//! Elimination order of a sparse symmetric matrix, and the supernodes of its Cholesky factor: whole numbers,
//! equal on every processor.
use super::assembly::Symmetric;

/// Number of columns up to which neighbouring supernodes are merged whatever zeros this stores: a panel of
/// fewer columns costs more to address than to compute.
const NARROW: usize = 16;
/// Largest share of stored zeros in a wider panel that is merged from two supernodes.
const ZEROS: f64 = 0.1;

/// Sparsity structure of a Cholesky factor with s supernodes (columns of the factor that are stored with one
/// sparsity pattern).
#[derive(Debug)]
pub(super) struct Elimination {
    /// Elimination order: index of the unknown eliminated at each step; length n.
    pub(super) order: Vec<usize>,
    /// First column of each supernode, followed by the number of columns; length s + 1.
    pub(super) columns: Vec<usize>,
    /// Row indices of each supernode below its own columns, ascending; length s.
    pub(super) rows: Vec<Vec<usize>>,
}

impl Elimination {
    /// Computes the elimination order by approximate minimum degree (Amestoy, Davis and Duff, SIAM J. Matrix
    /// Anal. Appl. 17, 1996) and the supernodes of the factor; `None` if the matrix has more entries than can
    /// be counted.
    pub(super) fn new(matrix: &Symmetric) -> Option<Self> {
        let order = minimum_degree(matrix)?;
        let adjacent = adjacent_before(matrix, &order);
        let parents = elimination_tree(&adjacent);
        let post = postorder(&parents);
        // columns of a supernode are neighbours only in postorder, which leaves the fill as it is
        let order: Vec<usize> = post.iter().map(|&step| order[step]).collect();
        let adjacent = adjacent_before(matrix, &order);
        let (columns, rows) = supernodes(&adjacent);
        Some(Self {
            order,
            columns,
            rows,
        })
    }
}

/// Returns a fill-reducing elimination order: the unknown eliminated at each step; `None` if indices overflow.
fn minimum_degree(matrix: &Symmetric) -> Option<Vec<usize>> {
    let (starts, rows) = matrix.pattern();
    let signed = |indices: &[usize]| -> Option<Vec<isize>> {
        let signed = indices.iter().map(|&index| isize::try_from(index).ok());
        signed.collect()
    };
    let (starts, rows) = (signed(starts)?, signed(rows)?);
    let order = isize::try_from(matrix.len()).ok()?;
    let (steps, _, _) = amd::order(order, &starts, &rows, &amd::Control::default()).ok()?;
    let steps = steps.into_iter().map(|step| usize::try_from(step).ok());
    steps.collect()
}

/// Returns for each step of an elimination order the earlier steps whose unknowns share an entry of the matrix
/// with that of the step.
fn adjacent_before(matrix: &Symmetric, order: &[usize]) -> Vec<Vec<usize>> {
    let mut steps = vec![0; order.len()];
    for (step, &unknown) in order.iter().enumerate() {
        steps[unknown] = step;
    }
    let mut adjacent = vec![Vec::new(); order.len()];
    for (row, column, _) in matrix.entries() {
        let (row, column) = (steps[row], steps[column]);
        if row != column {
            adjacent[row.max(column)].push(row.min(column));
        }
    }
    adjacent
}

/// Returns the elimination tree (Liu, 1990): the parent of each column is the row of the first entry below its
/// diagonal in the factor; `None` for a root.
fn elimination_tree(adjacent: &[Vec<usize>]) -> Vec<Option<usize>> {
    let mut parents = vec![None; adjacent.len()];
    // shortcuts towards the root of each column's subtree
    let mut ancestors: Vec<Option<usize>> = vec![None; adjacent.len()];
    for (row, adjacent) in adjacent.iter().enumerate() {
        for &column in adjacent {
            let mut next = Some(column);
            while let Some(at) = next.filter(|&at| at != row) {
                next = ancestors[at].replace(row);
                if next.is_none() {
                    parents[at] = Some(row);
                }
            }
        }
    }
    parents
}

/// Returns the columns of an elimination tree such that each subtree is contiguous and precedes its parent.
fn postorder(parents: &[Option<usize>]) -> Vec<usize> {
    let mut children = vec![Vec::new(); parents.len()];
    let mut open = Vec::new();
    for (column, parent) in parents.iter().enumerate() {
        match parent {
            Some(parent) => children[*parent].push(column),
            None => open.push(column),
        }
    }
    // parents before children, reversed at the end
    let mut order = Vec::with_capacity(parents.len());
    while let Some(column) = open.pop() {
        order.push(column);
        open.append(&mut children[column]);
    }
    order.reverse();
    order
}

/// Returns the first column of each supernode, followed by the number of columns, and the rows of each below
/// its own columns. Columns join the supernode before them where they continue its pattern, or where storing
/// zeros in their place costs little.
fn supernodes(adjacent: &[Vec<usize>]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let order = adjacent.len();
    let mut below = vec![Vec::new(); order];
    for (row, adjacent) in adjacent.iter().enumerate() {
        for &column in adjacent {
            below[column].push(row);
        }
    }
    let (mut firsts, mut patterns): (Vec<usize>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
    // supernodes whose first row below is a column; stored zeros of the last supernode
    let mut children: Vec<Vec<usize>> = vec![Vec::new(); order];
    let mut zeros = 0;
    let mut seen = vec![usize::MAX; order];
    for (column, mut rows) in below.into_iter().enumerate() {
        for &row in &rows {
            seen[row] = column;
        }
        for &child in &children[column] {
            for &row in patterns[child].iter().filter(|&&row| row > column) {
                if std::mem::replace(&mut seen[row], column) != column {
                    rows.push(row);
                }
            }
        }
        rows.sort_unstable();
        let last = patterns.len().wrapping_sub(1);
        if let (Some(&first), Some(pattern)) = (firsts.last(), patterns.last())
            && children[column].last() == Some(&last)
        {
            let width = column - first + 1;
            let more = zeros + (width - 1) * (rows.len() + 1 - pattern.len());
            let size = width * (width + 1) / 2 + width * rows.len();
            if more == zeros || width <= NARROW || more as f64 <= ZEROS * size as f64 {
                zeros = more;
                if let Some(&row) = rows.first() {
                    children[row].push(last);
                }
                patterns[last] = rows;
                continue;
            }
        }
        zeros = 0;
        firsts.push(column);
        if let Some(&row) = rows.first() {
            children[row].push(patterns.len());
        }
        patterns.push(rows);
    }
    firsts.push(order);
    (firsts, patterns)
}
