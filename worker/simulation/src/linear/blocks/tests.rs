//! Tests of the bordered block-tridiagonal matrix.
use super::*;

/// Returns a well-conditioned matrix without symmetry, with nonzeros wherever the structure allows.
fn example(lead: usize, touch_from: &[usize]) -> Blocks<6> {
    let chains = [4, 7];
    let mut a = Blocks::<6>::new(&chains, [lead, 3]);
    let mut seed = 1_u64;
    let mut next = || {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((seed >> 33) as f64 / f64::from(u32::MAX)) - 0.25
    };
    let mut first = 0;
    for (chain, &count) in chains.iter().enumerate() {
        for b in first..first + count {
            *a.diagonal_mut(b) =
                MatrixBlock::<6>::from_fn(|i, j| next() + if i == j { 4.0 } else { 0.0 });
            if b + 1 < first + count {
                let (upper, lower) = a.coupling_mut(b);
                *upper = MatrixBlock::<6>::from_fn(|_, _| next());
                *lower = MatrixBlock::<6>::from_fn(|_, _| next());
            }
            if b >= first + touch_from[chain] {
                for k in 0..3 {
                    for i in 0..6 {
                        a.add_right(b, i, k, next());
                        a.add_bottom(b, k, i, next());
                    }
                }
            }
        }
        first += count;
    }
    for i in 0..3 {
        for j in 0..3 {
            a.add_corner(i, j, next() + if i == j { 5.0 } else { 0.0 });
        }
    }
    // a body that both chains hang on, in the lead of the border
    let base = a.len() - 3 - lead;
    for k in base..base + lead {
        a.add(k, k, 4.0);
        a.add(k, a.len() - 1, next());
        for first in [0, chains[0]] {
            for i in 6 * first..6 * first + 6 {
                a.add(k, i, next());
                a.add(i, k, next());
            }
        }
    }
    a
}

#[test]
fn solution_reproduces_the_right_hand_side() {
    for touch_from in [[0, 0], [2, 5], [4, 6], [4, 7]] {
        for lead in [0, 2] {
            let a = example(lead, &touch_from);
            let x: Vec<f64> = (0..a.len()).map(|i| 1.0 + 0.37 * (i % 11) as f64).collect();
            let mut y = vec![0.0; a.len()];
            a.multiply(&x, &mut y);
            let mut factors = a.clone();
            factors.factorize().unwrap();
            factors.solve(&mut y);
            let worst = x
                .iter()
                .zip(&y)
                .map(|(a, b)| (a - b).abs())
                .fold(0.0, f64::max);
            assert!(worst < 1e-11, "{lead} {touch_from:?}: {worst}");
        }
    }
}

#[test]
fn a_used_matrix_can_be_assembled_again() {
    let mut used = example(2, &[0, 2]);
    used.factorize().unwrap();
    used.clear();
    let mut zeros = vec![0.0; used.len()];
    used.multiply(&vec![1.0; used.len()], &mut zeros);
    assert!(zeros.iter().all(|&x| x == 0.0));
}

#[test]
fn a_singular_block_is_named() {
    let mut a = example(0, &[0, 0]);
    a.diagonal_mut(0).set_column(2, &nalgebra::Vector6::zeros());
    let (upper, _) = a.coupling_mut(0);
    upper.fill(0.0);
    assert_eq!(a.factorize(), Err(SingularPivot { unknown: 2 }));
}
