//! Computes the lowest natural modes by Lanczos iteration on the inverse stiffness.
//!
//! `K x = lambda M x` becomes `(K^-1 M) x = x / lambda`, whose largest eigenvalues converge first. The
//! iteration runs in the inner product of M, with full orthogonalisation applied twice, single-threaded and
//! from a fixed start vector, so that results are bitwise reproducible.
use super::{assembly::Assembly, cholesky::Factor, error::ReductionError};
use nalgebra::{DMatrix, SymmetricEigen};

/// Convergence tolerance of a mode: ratio of its residual to its eigenvalue.
const TOLERANCE: f64 = 1e-11;
/// Number of Lanczos steps between solutions of the projected (tridiagonal) eigenvalue problem.
const CONVERGENCE_CHECK_INTERVAL: usize = 8;

/// Natural modes in ascending order of frequency.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Modes {
    /// Squared angular frequencies [rad2/s2], one per mode.
    pub(super) eigenvalues: Vec<f64>,
    /// Mode shapes with unit modal mass, one vector over the unknowns per mode.
    pub(super) shapes: Vec<Vec<f64>>,
    /// Number of Lanczos steps made; each takes one linear solve.
    pub(super) steps: usize,
}

/// Computes the `count` modes of lowest frequency.
///
/// # Errors
/// [`ReductionError::Modes`] if the body has fewer modes or they do not converge.
pub(super) fn lowest(
    assembly: &Assembly,
    factor: &Factor,
    count: usize,
) -> Result<Modes, ReductionError> {
    let order = assembly.mass.len();
    let limit = order.min(20 * count + 100);
    let mut space = Space::default();
    let mut next = start(order);
    while space.basis.len() < limit {
        // whatever a rounding error brings back of earlier directions is taken out once more
        space.orthogonalize(&mut next);
        space.orthogonalize(&mut next);
        let weighed = assembly.mass.times(&next);
        let length = dot(&next, &weighed).max(0.0).sqrt();
        let exhausted = length <= 1e-13 * space.scale;
        if space.basis.len().is_multiple_of(CONVERGENCE_CHECK_INTERVAL) || exhausted {
            if let Some(modes) = space.modes(count, if exhausted { 0.0 } else { length }) {
                return Ok(modes);
            }
            if exhausted {
                break;
            }
        }
        next = space.extend(&next, &weighed, length, factor);
    }
    if space.basis.len() == order
        && let Some(modes) = space.modes(count, 0.0)
    {
        return Ok(modes);
    }
    Err(ReductionError::Modes {
        wanted: count,
        steps: space.basis.len(),
    })
}

/// Returns a pseudo-random start vector, the same on every machine; being without symmetry, it has a
/// component along every mode.
fn start(order: usize) -> Vec<f64> {
    let mut state: u64 = 0x9e37_79b9_7f4a_7c15;
    (0..order)
        .map(|_| {
            // a linear congruential generator: equal on every machine
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        })
        .collect()
}

/// Krylov space of the Lanczos iteration: `K^-1 M Q = Q T + remainder`.
#[derive(Debug, Default)]
struct Space {
    basis: Vec<Vec<f64>>,
    /// Basis vectors of the Krylov space multiplied by the mass matrix.
    weighed: Vec<Vec<f64>>,
    diagonal: Vec<f64>,
    off_diagonal: Vec<f64>,
    scale: f64,
}

impl Space {
    /// Orthogonalises a vector against the Krylov basis in the inner product of the mass matrix.
    fn orthogonalize(&self, vector: &mut [f64]) {
        for (direction, weighed) in self.basis.iter().zip(&self.weighed) {
            let part = dot(vector, weighed);
            for (entry, along) in vector.iter_mut().zip(direction) {
                *entry -= part * along;
            }
        }
    }

    /// Extends the Krylov basis by the direction `next` divided by its norm `length`; returns `K^-1 M` times
    /// the new basis vector.
    fn extend(&mut self, next: &[f64], weighed: &[f64], length: f64, factor: &Factor) -> Vec<f64> {
        let scaled = |vector: &[f64]| vector.iter().map(|x| x / length).collect::<Vec<f64>>();
        if !self.basis.is_empty() {
            self.off_diagonal.push(length);
        }
        self.basis.push(scaled(next));
        let weighed = scaled(weighed);
        let mut answer = weighed.clone();
        factor.solve(&mut answer);
        self.diagonal.push(dot(&answer, &weighed));
        self.scale = self.diagonal.iter().copied().fold(0.0, f64::max);
        self.weighed.push(weighed);
        answer
    }

    /// Returns the `count` lowest modes if all of them have converged, else `None`; `remainder` is the norm
    /// of the Lanczos remainder, the next off-diagonal entry.
    fn modes(&self, count: usize, remainder: f64) -> Option<Modes> {
        let size = self.basis.len();
        if size < count {
            return None;
        }
        let mut small = DMatrix::zeros(size, size);
        for (k, value) in self.diagonal.iter().enumerate() {
            small[(k, k)] = *value;
        }
        for (k, value) in self.off_diagonal.iter().enumerate() {
            small[(k, k + 1)] = *value;
            small[(k + 1, k)] = *value;
        }
        let eigen = SymmetricEigen::new(small);
        let mut order: Vec<usize> = (0..size).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*b].total_cmp(&eigen.eigenvalues[*a]));
        let mut modes = Modes {
            eigenvalues: Vec::new(),
            shapes: Vec::new(),
            steps: size,
        };
        for &k in &order[..count] {
            let value = eigen.eigenvalues[k];
            let weights = eigen.eigenvectors.column(k);
            if value <= 0.0 || remainder * weights[size - 1].abs() > TOLERANCE * value {
                return None;
            }
            let mut shape = vec![0.0; self.basis[0].len()];
            for (direction, weight) in self.basis.iter().zip(&weights) {
                for (entry, along) in shape.iter_mut().zip(direction) {
                    *entry += weight * along;
                }
            }
            modes.eigenvalues.push(1.0 / value);
            modes.shapes.push(shape);
        }
        Some(modes)
    }
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
