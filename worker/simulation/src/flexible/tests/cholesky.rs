//! Comparison of the Cholesky factor with that of faer, whose results depend on the processor only in their
//! last bits.
use super::*;
use faer::{
    Side,
    linalg::solvers::Solve,
    mat::MatMut,
    sparse::{
        SparseColMatRef, SymbolicSparseColMatRef,
        linalg::solvers::{Llt, SymbolicLlt},
    },
};

/// Solves a linear system with faer's Cholesky factorisation.
fn by_faer(matrix: &Symmetric, right: &[f64]) -> Vec<f64> {
    let (starts, rows) = matrix.pattern();
    let values: Vec<f64> = matrix.entries().map(|(_, _, value)| value).collect();
    let order = matrix.len();
    let pattern = SymbolicSparseColMatRef::new_checked(order, order, starts, None, rows);
    let plan = SymbolicLlt::try_new(pattern, Side::Lower).unwrap();
    let matrix = SparseColMatRef::new(pattern, &values[..]);
    let factor = Llt::try_new_with_symbolic(plan, matrix, Side::Lower).unwrap();
    let mut solution = right.to_vec();
    factor.solve_in_place(MatMut::from_column_major_slice_mut(&mut solution, order, 1));
    solution
}

/// Checks solutions against faer and against a known solution, for factors of one to hundreds of supernodes,
/// with panels narrower and wider than a tile and than a block.
#[test]
fn solutions_are_those_of_faer_and_of_the_matrix() {
    for counts in [[1, 1, 1], [3, 1, 1], [7, 2, 3], [9, 7, 6], [30, 6, 4]] {
        let mesh = bricks(counts, [1.0, 2.0, 1.5], [0.0; 3], distort);
        let (unknowns, assembly) = problem(&mesh);
        let known: Vec<f64> = (0..unknowns.len())
            .map(|k| sin_cos(0.7 * k as f64).0)
            .collect();
        let right = assembly.stiffness.times(&known);
        let mut ours = right.clone();
        Factor::new(&assembly.stiffness).unwrap().solve(&mut ours);
        let theirs = by_faer(&assembly.stiffness, &right);
        let apart = |a: &[f64], b: &[f64]| {
            let pairs = a.iter().zip(b);
            pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
        };
        let (exact, other) = (apart(&ours, &known), apart(&ours, &theirs));
        assert!(
            exact < 1e-11 && other < 1e-11,
            "{counts:?}: {exact} {other}"
        );
    }
}
