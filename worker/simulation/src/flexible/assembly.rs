//! Assembly of the sparse stiffness and mass matrices of a mesh.
//!
//! Both matrices are symmetric; the lower triangle is stored column by column, so that every sum has a fixed
//! order. Independent of rims, gauges and modes.
use super::{element::Steel, error::ReductionError, mesh::Mesh};
use std::collections::BTreeSet;

/// Numbering of the unknown nodal displacements (degrees of freedom) of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Unknowns {
    /// Index among the unknowns of each node's displacements in x, y and z; `None` for a fixed displacement.
    numbers: Vec<[Option<usize>; 3]>,
    count: usize,
}

impl Unknowns {
    /// Numbers every displacement of `nodes` nodes for which `free(node, axis)` holds.
    pub(super) fn new(nodes: usize, free: impl Fn(usize, usize) -> bool) -> Self {
        let mut count = 0;
        let numbers = (0..nodes)
            .map(|node| {
                [0, 1, 2].map(|axis| {
                    free(node, axis).then(|| {
                        count += 1;
                        count - 1
                    })
                })
            })
            .collect();
        Self { numbers, count }
    }

    pub(super) const fn len(&self) -> usize {
        self.count
    }

    /// Returns the index among the unknowns of a node's displacement; `None` if it is fixed.
    pub(super) fn number(&self, node: usize, axis: usize) -> Option<usize> {
        self.numbers[node][axis]
    }

    /// Expands a vector of unknowns to displacements of all nodes, zero where fixed.
    pub(super) fn spread(&self, vector: &[f64]) -> Vec<[f64; 3]> {
        let value = |number: &Option<usize>| number.map_or(0.0, |number| vector[number]);
        self.numbers
            .iter()
            .map(|numbers| numbers.each_ref().map(value))
            .collect()
    }

    /// Collects the unknown displacements of a field over all nodes.
    pub(super) fn gather(&self, field: &[[f64; 3]]) -> Vec<f64> {
        let pairs = self.numbers.iter().flatten().zip(field.iter().flatten());
        pairs
            .filter(|(number, _)| number.is_some())
            .map(|(_, value)| *value)
            .collect()
    }
}

/// Sparse symmetric matrix: the lower triangle in compressed columns, rows ascending.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Symmetric {
    starts: Vec<usize>,
    rows: Vec<usize>,
    values: Vec<f64>,
}

impl Symmetric {
    /// Returns the number of rows (and columns) of the matrix.
    pub(super) const fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// Computes the product `self * vector`.
    pub(super) fn times(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; vector.len()];
        for column in 0..self.len() {
            let mut sum = 0.0;
            for k in self.starts[column]..self.starts[column + 1] {
                let (row, value) = (self.rows[k], self.values[k]);
                sum += value * vector[row];
                if row != column {
                    product[row] += value * vector[column];
                }
            }
            product[column] += sum;
        }
        product
    }

    /// Returns the sparsity pattern: the start index of each column followed by the number of stored entries,
    /// and the row index of every stored entry.
    pub(super) fn pattern(&self) -> (&[usize], &[usize]) {
        (&self.starts, &self.rows)
    }

    /// Iterates over the stored matrix entries as row, column and value.
    pub(super) fn entries(&self) -> impl Iterator<Item = (usize, usize, f64)> {
        (0..self.len()).flat_map(move |column| {
            let range = self.starts[column]..self.starts[column + 1];
            range.map(move |k| (self.rows[k], column, self.values[k]))
        })
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        let (from, to) = (self.starts[column], self.starts[column + 1]);
        if let Ok(at) = self.rows[from..to].binary_search(&row) {
            self.values[from + at] += value;
        }
    }
}

/// Assembled stiffness [N/m] and mass \[kg\] matrices over the unknown displacements of a mesh.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Assembly {
    pub(super) stiffness: Symmetric,
    /// Consistent mass matrix.
    pub(super) mass: Symmetric,
}

impl Assembly {
    /// Assembles stiffness and mass matrices from the elements of a mesh, in their order.
    ///
    /// # Errors
    /// [`ReductionError::InvertedElement`] with the index of an inverted element.
    pub(super) fn new(
        mesh: &Mesh,
        steel: &Steel,
        unknowns: &Unknowns,
    ) -> Result<Self, ReductionError> {
        let mut stiffness = pattern(mesh, unknowns);
        let mut mass = stiffness.clone();
        for (element, nodes) in mesh.elements().enumerate() {
            let inside_out = |_| ReductionError::InvertedElement { element };
            let own = mesh.law().matrices(&mesh.places(nodes), steel);
            let own = own.map_err(inside_out)?;
            for (i, a) in each(nodes, unknowns) {
                for (j, b) in each(nodes, unknowns) {
                    if a >= b {
                        stiffness.add(a, b, own.stiffness[(i, j)]);
                        mass.add(a, b, own.mass[(i, j)]);
                    }
                }
            }
        }
        Ok(Self { stiffness, mass })
    }
}

/// Iterates over an element's free displacements as pairs of local index (within the element) and global
/// index (among the unknowns).
fn each(nodes: &[usize], unknowns: &Unknowns) -> impl Iterator<Item = (usize, usize)> {
    (0..3 * nodes.len()).filter_map(|i| Some((i, unknowns.number(nodes[i / 3], i % 3)?)))
}

/// Creates a zero matrix with an entry for every pair of unknowns that share an element.
fn pattern(mesh: &Mesh, unknowns: &Unknowns) -> Symmetric {
    let mut neighbours = vec![BTreeSet::new(); mesh.nodes.len()];
    for element in mesh.elements() {
        for &node in element {
            neighbours[node].extend(element);
        }
    }
    let mut starts = vec![0];
    let mut rows = Vec::new();
    for (node, around) in neighbours.iter().enumerate() {
        for axis in 0..3 {
            let Some(column) = unknowns.number(node, axis) else {
                continue;
            };
            let numbers = around
                .iter()
                .flat_map(|&other| (0..3).filter_map(move |axis| unknowns.number(other, axis)));
            rows.extend(numbers.filter(|row| *row >= column));
            starts.push(rows.len());
        }
    }
    Symmetric {
        values: vec![0.0; rows.len()],
        starts,
        rows,
    }
}
