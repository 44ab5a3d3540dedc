//! The equations of motion as an integrator sees them.
use crate::integrator::State;
use crate::linear::{Bordered, SingularPivot};
use crate::model::Powers;
use crate::statistics::Statistics;

/// Equations of motion `M(q) a = Q(q, v, t)` whose iteration matrix is chains with a border.
///
/// What is evaluated after a call of [`Equations::forces`] (tangent, powers, potential) may use
/// the loads that this call left behind: it must be asked for the same state.
pub trait Equations {
    /// An empty matrix of the right shape: allocates.
    fn matrix(&self) -> Bordered;

    /// Generalised forces `Q(q, v, t)`.
    fn forces(&mut self, t: f64, q: &[f64], v: &[f64], force: &mut [f64]);

    /// `out -= M(q) a`.
    fn subtract_inertia(&self, q: &[f64], a: &[f64], out: &mut [f64]);

    /// Fills `matrix` with `mu M - gamma D - K`, where `K = dQ/dq` and `D = dQ/dv`.
    fn tangent(
        &mut self,
        t: f64,
        state: (&[f64], &[f64]),
        coefficients: (f64, f64),
        matrix: &mut Bordered,
    );

    /// Adds what [`Equations::tangent`] leaves out of `-gamma D - K`: the derivatives of velocity
    /// terms and of `M(q) a`, `state` being coordinates, rates and accelerations.
    fn add_spin_tangent(&self, state: (&[f64], &[f64], &[f64]), gamma: f64, matrix: &mut Bordered);

    /// Largest change over all coordinates, in units of Newton's accuracy.
    fn newton_norm(&self, change: &[f64]) -> f64;

    /// Local error, in units of what is tolerated.
    fn error_norm(&self, error: &[f64]) -> f64;

    /// Powers at a state whose loads are at hand.
    fn powers(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64]) -> Powers;
}

/// Equations that derive from a potential at rest: what a search for equilibrium needs.
pub trait Static: Equations {
    /// Potential of all forces, loads included, at a state whose loads are at hand \[J\].
    fn potential(&mut self, t: f64, q: &[f64], still: &[f64]) -> f64;

    /// Adds `lambda W`: `W` measures a metre of every body alike.
    fn add_static_weight(&self, lambda: f64, matrix: &mut Bordered);
}

/// Equations with their iteration matrix and their work counters.
#[derive(Debug)]
pub struct System<E> {
    /// The equations.
    pub equations: E,
    /// Work done so far.
    pub statistics: Statistics,
    matrix: Bordered,
}

impl<E: Equations> System<E> {
    /// Allocates the matrix.
    pub fn new(equations: E) -> Self {
        Self {
            matrix: equations.matrix(),
            equations,
            statistics: Statistics::default(),
        }
    }

    /// Number of coordinates.
    pub fn len(&self) -> usize {
        self.matrix.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// `Q(q, v, t)`.
    pub fn forces(&mut self, t: f64, q: &[f64], v: &[f64], force: &mut [f64]) {
        self.statistics.force_evaluations += 1;
        self.equations.forces(t, q, v, force);
    }

    /// Residual `Q - M a`.
    pub fn residual(&mut self, t: f64, q: &[f64], v: &[f64], a: &[f64], out: &mut [f64]) {
        self.forces(t, q, v, out);
        self.equations.subtract_inertia(q, a, out);
    }

    /// Factorises `mu M - gamma D - K` at the state of the last force evaluation.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize(
        &mut self,
        t: f64,
        state: (&[f64], &[f64]),
        coefficients: (f64, f64),
    ) -> Result<(), SingularPivot> {
        self.statistics.jacobians += 1;
        self.equations
            .tangent(t, state, coefficients, &mut self.matrix);
        self.statistics.factorizations += 1;
        self.matrix.factorize()
    }

    /// Fills `matrix` with the complete `mu M - gamma D - K`, `K` the derivative of `Q - M a` by the
    /// coordinates, at the state of the last force evaluation.
    pub fn exact_tangent(
        &mut self,
        state: &State,
        coefficients: (f64, f64),
        matrix: &mut Bordered,
    ) {
        self.statistics.jacobians += 1;
        exact_tangent(&mut self.equations, state, coefficients, matrix);
    }

    /// Factorises the same.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize_exact(
        &mut self,
        state: &State,
        coefficients: (f64, f64),
    ) -> Result<(), SingularPivot> {
        self.statistics.jacobians += 1;
        exact_tangent(&mut self.equations, state, coefficients, &mut self.matrix);
        self.statistics.factorizations += 1;
        self.matrix.factorize()
    }

    /// Accelerations at a motion that does not start from equilibrium: `M a = Q`.
    ///
    /// Solved as `(mu M - K) x = Q`, `a = mu x` with a `mu` beside which `K` is below rounding.
    ///
    /// # Errors
    /// The unknown whose inertia vanishes.
    pub fn accelerations(
        &mut self,
        t: f64,
        q: &[f64],
        v: &[f64],
        a: &mut [f64],
    ) -> Result<(), SingularPivot> {
        const MU: f64 = 1e30;
        self.forces(t, q, v, a);
        self.factorize(t, (q, v), (MU, 0.0))?;
        self.solve(a);
        for a in a {
            *a *= MU;
        }
        Ok(())
    }

    /// Solves with the last factorisation, in place.
    pub fn solve(&self, x: &mut [f64]) {
        self.matrix.solve(x);
    }
}

fn exact_tangent<E: Equations>(
    equations: &mut E,
    State { t, q, v, a }: &State,
    coefficients: (f64, f64),
    matrix: &mut Bordered,
) {
    equations.tangent(*t, (q, v), coefficients, matrix);
    equations.add_spin_tangent((q, v, a), coefficients.1, matrix);
}

impl<E: Static> System<E> {
    /// Factorises `-K + lambda W` at the state of the last force evaluation.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize_static(
        &mut self,
        t: f64,
        state: (&[f64], &[f64]),
        lambda: f64,
    ) -> Result<(), SingularPivot> {
        self.statistics.jacobians += 1;
        self.equations
            .tangent(t, state, (0.0, 0.0), &mut self.matrix);
        if lambda > 0.0 {
            self.equations.add_static_weight(lambda, &mut self.matrix);
        }
        self.statistics.factorizations += 1;
        self.matrix.factorize()
    }
}
