//! Interface between the equations of motion and the integrators.
//!
//! A force evaluation leaves loads behind (poses, joint loads, contact), from which the tangent, the powers
//! and the potential are computed. [`System::forces`] returns [`Loads`], the only access to these quantities:
//! it borrows both the state and the equations, so neither can change while it exists, and every answer
//! belongs to the state for which the loads were computed.
use crate::linear::{Bordered, MatrixEntry, SingularPivot};
pub use crate::state::{Powers, State, StateRef, StateShift};
use crate::statistics::Statistics;

/// Equations of motion `M(q) a = Q(q, v, t)` whose iteration matrix is a bordered matrix: one diagonal block
/// per rope chain, and a border.
pub trait Equations {
    /// Allocates a zero matrix of the shape of the iteration matrix.
    fn matrix(&self) -> Bordered;

    /// Computes the generalised forces `Q(q, v, t)` and stores the poses, joint loads and contact from which
    /// they result.
    fn forces(&mut self, at: StateRef<'_>, force: &mut [f64]);

    /// Computes `out -= M(q) a`, for one vector of accelerations or for several vectors side by side in SIMD
    /// lanes.
    fn subtract_inertia<T: MatrixEntry>(&self, q: &[f64], a: &[T], out: &mut [T]);

    /// Fills `matrix` with the iteration matrix `mass M - damping D - K`, with the factors `mass` and
    /// `damping` of `shift`.
    fn tangent(&self, at: LoadedState<'_>, shift: StateShift, matrix: &mut Bordered);

    /// Fills the first matrix with `-K`, the second as [`Equations::tangent`] does.
    fn tangents(
        &self,
        at: LoadedState<'_>,
        shift: StateShift,
        [stiffness, matrix]: [&mut Bordered; 2],
    ) {
        self.tangent(at, StateShift::NONE, stiffness);
        self.tangent(at, shift, matrix);
    }

    /// Adds what [`Equations::tangent`] leaves out of `-damping D - K`: the derivatives of velocity
    /// terms and of `M(q) a` under accelerations `a`.
    fn add_velocity_inertia_tangent(
        &self,
        at: StateRef<'_>,
        a: &[f64],
        damping: f64,
        matrix: &mut Bordered,
    );

    /// Returns the largest change of any coordinate in a Newton step, in units of the accuracy required of
    /// Newton's method.
    fn newton_norm(&self, change: &[f64]) -> f64;

    /// Returns the norm of the local error of a time step, in units of the error tolerance.
    fn error_norm(&self, error: &[f64]) -> f64;

    /// Computes input, output and dissipated power for the accelerations `a`.
    fn powers(&self, at: LoadedState<'_>, a: &[f64]) -> Powers;
}

/// Equations whose forces derive from a potential at rest, as the search for static equilibrium requires.
pub trait Static: Equations {
    /// Returns the potential of all forces, including the loads, at a state of rest \[J\].
    fn potential(&self, at: LoadedState<'_>) -> f64;

    /// Adds `lambda W` to the matrix, where the weight `W` counts a displacement of one metre equally for
    /// every body.
    fn add_static_weight(&self, lambda: f64, matrix: &mut Bordered);
}

/// State whose loads are stored in the equations. Created only by [`System::forces`] and [`KeptLoads`].
#[derive(Clone, Copy, Debug)]
pub struct LoadedState<'a>(StateRef<'a>);

impl<'a> LoadedState<'a> {
    /// Returns the coordinates and rates for which the loads were computed.
    pub const fn state(self) -> StateRef<'a> {
        self.0
    }
}

/// Equations of motion with their iteration matrix and their work counters.
#[derive(Debug)]
pub struct System<E> {
    /// Equations of motion of the system.
    pub equations: E,
    /// Work counters since the system was created.
    pub statistics: Statistics,
    matrix: Bordered,
}

/// Access to the loads of a state, and to the system that stores them.
#[derive(Debug)]
pub struct Loads<'s, 'q, E> {
    system: &'s mut System<E>,
    at: LoadedState<'q>,
}

/// Loads of a state that remain stored while Newton's method corrects that state.
#[derive(Debug)]
pub struct KeptLoads<'s, E> {
    equations: &'s E,
}

impl<E: Equations> KeptLoads<'_, E> {
    /// Computes the powers at the corrected state for the accelerations `a`. The loads used are those before
    /// the last correction, rates and accelerations those after it; this halves the error compared with using
    /// old values of all.
    pub fn powers(&self, corrected: StateRef<'_>, a: &[f64]) -> Powers {
        self.equations.powers(LoadedState(corrected), a)
    }
}

impl<E: Equations> System<E> {
    /// Creates a system from its equations of motion and allocates its iteration matrix.
    pub fn new(equations: E) -> Self {
        Self {
            matrix: equations.matrix(),
            equations,
            statistics: Statistics::default(),
        }
    }

    /// Returns the number of coordinates of the system.
    pub fn len(&self) -> usize {
        self.matrix.len()
    }

    /// Returns whether the system has no coordinates.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Computes the forces `Q(q, v, t)` and returns access to their loads.
    pub fn forces<'q>(&mut self, at: StateRef<'q>, force: &mut [f64]) -> Loads<'_, 'q, E> {
        self.statistics.force_evaluations += 1;
        self.equations.forces(at, force);
        Loads {
            system: self,
            at: LoadedState(at),
        }
    }

    /// Computes the residual `Q - M a` and returns access to the loads.
    pub fn residual<'q>(
        &mut self,
        at: StateRef<'q>,
        a: &[f64],
        out: &mut [f64],
    ) -> Loads<'_, 'q, E> {
        let loads = self.forces(at, out);
        loads.equations().subtract_inertia(at.q, a, out);
        loads
    }

    /// Computes the accelerations from `M a = Q`, for a motion that does not start from equilibrium.
    ///
    /// Solved as `(mass M - K) x = Q`, `a = mass x`, with `mass` so large that `K` is below rounding error.
    ///
    /// # Errors
    /// [`SingularPivot`] naming the unknown that has no inertia.
    pub fn accelerations(&mut self, at: StateRef<'_>, a: &mut [f64]) -> Result<(), SingularPivot> {
        const SHIFT: StateShift = StateShift {
            mass: 1e30,
            damping: 0.0,
        };
        self.forces(at, a).factorize(SHIFT)?;
        self.solve(a);
        for a in a {
            *a *= SHIFT.mass;
        }
        Ok(())
    }

    /// Solves a linear system with the last factorised matrix, in place.
    pub fn solve(&self, x: &mut [f64]) {
        self.matrix.solve(x);
    }
}

impl<'s, 'q, E: Equations> Loads<'s, 'q, E> {
    /// Returns the state for which the loads were computed.
    pub const fn state(&self) -> StateRef<'q> {
        self.at.state()
    }

    /// Returns the equations of motion that store the loads.
    pub const fn equations(&self) -> &E {
        &self.system.equations
    }

    /// Returns the work counters of the system.
    pub const fn statistics(&mut self) -> &mut Statistics {
        &mut self.system.statistics
    }

    /// Fills `matrix` with `mass M - damping D - K`.
    pub fn tangent(&mut self, shift: StateShift, matrix: &mut Bordered) {
        self.system.statistics.jacobians += 1;
        self.system.equations.tangent(self.at, shift, matrix);
    }

    /// Fills `matrix` with the complete `mass M - damping D - K`, where `K` is the derivative of `Q - M a`
    /// with respect to the coordinates.
    pub fn exact_tangent(&mut self, a: &[f64], shift: StateShift, matrix: &mut Bordered) {
        self.tangent(shift, matrix);
        let equations = &self.system.equations;
        equations.add_velocity_inertia_tangent(self.state(), a, shift.damping, matrix);
    }

    /// Fills the first matrix with the complete `-K`, the second as [`Self::exact_tangent`] does.
    pub fn exact_tangents(
        &mut self,
        a: &[f64],
        shift: StateShift,
        [stiffness, matrix]: [&mut Bordered; 2],
    ) {
        let System {
            equations,
            statistics,
            ..
        } = &mut *self.system;
        statistics.jacobians += 1;
        equations.tangents(self.at, shift, [&mut *stiffness, &mut *matrix]);
        let at = self.at.state();
        equations.add_velocity_inertia_tangent(at, a, 0.0, stiffness);
        equations.add_velocity_inertia_tangent(at, a, shift.damping, matrix);
    }

    /// Factorises `mass M - damping D - K`.
    ///
    /// # Errors
    /// [`SingularPivot`] naming the unknown whose pivot vanished.
    pub fn factorize(&mut self, shift: StateShift) -> Result<(), SingularPivot> {
        let System {
            equations,
            statistics,
            matrix,
        } = &mut *self.system;
        equations.tangent(self.at, shift, matrix);
        factorize(statistics, matrix)
    }

    /// Factorises the exact iteration matrix, as defined at [`Self::exact_tangent`].
    ///
    /// # Errors
    /// [`SingularPivot`] naming the unknown whose pivot vanished.
    pub fn factorize_exact(&mut self, a: &[f64], shift: StateShift) -> Result<(), SingularPivot> {
        let System {
            equations,
            statistics,
            matrix,
        } = &mut *self.system;
        equations.tangent(self.at, shift, matrix);
        equations.add_velocity_inertia_tangent(self.at.state(), a, shift.damping, matrix);
        factorize(statistics, matrix)
    }

    /// Computes input, output and dissipated power for the accelerations `a`.
    pub fn powers(&self, a: &[f64]) -> Powers {
        self.system.equations.powers(self.at, a)
    }

    /// Releases the state, so that Newton's method can correct it, and keeps the loads.
    pub const fn release_state(self) -> KeptLoads<'s, E> {
        KeptLoads {
            equations: &self.system.equations,
        }
    }

    /// Solves a linear system with the last factorised matrix, in place.
    pub fn solve(&self, x: &mut [f64]) {
        self.system.solve(x);
    }
}

impl<E: Static> Loads<'_, '_, E> {
    /// Returns the potential of all forces, including the loads \[J\].
    pub fn potential(&self) -> f64 {
        self.system.equations.potential(self.at)
    }

    /// Factorises the stiffness matrix damped for statics, `-K + lambda W`, with the weight `W` of
    /// [`Static::add_static_weight`].
    ///
    /// # Errors
    /// [`SingularPivot`] naming the unknown whose pivot vanished.
    pub fn factorize_static(&mut self, lambda: f64) -> Result<(), SingularPivot> {
        let System {
            equations,
            statistics,
            matrix,
        } = &mut *self.system;
        equations.tangent(self.at, StateShift::NONE, matrix);
        if lambda > 0.0 {
            equations.add_static_weight(lambda, matrix);
        }
        factorize(statistics, matrix)
    }
}

fn factorize(statistics: &mut Statistics, matrix: &mut Bordered) -> Result<(), SingularPivot> {
    statistics.jacobians += 1;
    statistics.factorizations += 1;
    matrix.factorize()
}
