//! The equations of motion as an integrator sees them.
//!
//! Forces leave loads behind (poses, joint loads, contact) that tangent, powers and potential are made
//! of. [`System::forces`] gives [`Loads`], the only way to ask for these: it holds both the state and the
//! equations, so that neither can change while it is there, and what it answers belongs to the state
//! that it was made for.
use crate::linear::{Bordered, Entry, SingularPivot};
pub use crate::state::{Powers, Shift, State, StateRef};
use crate::statistics::Statistics;

/// Equations of motion `M(q) a = Q(q, v, t)` whose iteration matrix is chains with a border.
pub trait Equations {
    /// An empty matrix of the right shape: allocates.
    fn matrix(&self) -> Bordered;

    /// Generalised forces `Q(q, v, t)`; their loads are kept.
    fn forces(&mut self, at: StateRef<'_>, force: &mut [f64]);

    /// `out -= M(q) a`, of one column or of several side by side.
    fn subtract_inertia<T: Entry>(&self, q: &[f64], a: &[T], out: &mut [T]);

    /// Fills `matrix` with `mass M - damping D - K`.
    fn tangent(&self, at: Loaded<'_>, shift: Shift, matrix: &mut Bordered);

    /// Fills the first matrix with `-K`, the second as [`Equations::tangent`] does.
    fn tangents(&self, at: Loaded<'_>, shift: Shift, [stiffness, matrix]: [&mut Bordered; 2]) {
        self.tangent(at, Shift::NONE, stiffness);
        self.tangent(at, shift, matrix);
    }

    /// Adds what [`Equations::tangent`] leaves out of `-damping D - K`: the derivatives of velocity
    /// terms and of `M(q) a` under accelerations `a`.
    fn add_spin_tangent(&self, at: StateRef<'_>, a: &[f64], damping: f64, matrix: &mut Bordered);

    /// Largest change over all coordinates, in units of Newton's accuracy.
    fn newton_norm(&self, change: &[f64]) -> f64;

    /// Local error, in units of what is tolerated.
    fn error_norm(&self, error: &[f64]) -> f64;

    /// Powers under accelerations `a`.
    fn powers(&self, at: Loaded<'_>, a: &[f64]) -> Powers;
}

/// Equations that derive from a potential at rest: what a search for equilibrium needs.
pub trait Static: Equations {
    /// Potential of all forces, loads included, at a state of rest \[J\].
    fn potential(&self, at: Loaded<'_>) -> f64;

    /// Adds `lambda W`: `W` measures a metre of every body alike.
    fn add_static_weight(&self, lambda: f64, matrix: &mut Bordered);
}

/// A state whose loads the equations hold; made by [`System::forces`] alone, and by what outlives it.
#[derive(Clone, Copy, Debug)]
pub struct Loaded<'a>(StateRef<'a>);

impl<'a> Loaded<'a> {
    /// The state.
    pub const fn state(self) -> StateRef<'a> {
        self.0
    }
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

/// A system with the loads of a state.
#[derive(Debug)]
pub struct Loads<'s, 'q, E> {
    system: &'s mut System<E>,
    at: Loaded<'q>,
}

/// Loads that outlive their state while Newton's method corrects it.
#[derive(Debug)]
pub struct KeptLoads<'s, E> {
    equations: &'s E,
}

impl<E: Equations> KeptLoads<'_, E> {
    /// Powers at the corrected state under accelerations `a`: the loads lag by the last correction,
    /// rates and accelerations do not, which is half of the error that lagging with both would make.
    pub fn powers(&self, corrected: StateRef<'_>, a: &[f64]) -> Powers {
        self.equations.powers(Loaded(corrected), a)
    }
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

    /// `Q(q, v, t)`, and what its loads answer.
    pub fn forces<'q>(&mut self, at: StateRef<'q>, force: &mut [f64]) -> Loads<'_, 'q, E> {
        self.statistics.force_evaluations += 1;
        self.equations.forces(at, force);
        Loads {
            system: self,
            at: Loaded(at),
        }
    }

    /// Residual `Q - M a`, and what its loads answer.
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

    /// Accelerations at a motion that does not start from equilibrium: `M a = Q`.
    ///
    /// Solved as `(mass M - K) x = Q`, `a = mass x` with a `mass` beside which `K` is below rounding.
    ///
    /// # Errors
    /// The unknown whose inertia vanishes.
    pub fn accelerations(&mut self, at: StateRef<'_>, a: &mut [f64]) -> Result<(), SingularPivot> {
        const SHIFT: Shift = Shift {
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

    /// Solves with the last factorisation, in place.
    pub fn solve(&self, x: &mut [f64]) {
        self.matrix.solve(x);
    }
}

impl<'s, 'q, E: Equations> Loads<'s, 'q, E> {
    /// The state that they belong to.
    pub const fn state(&self) -> StateRef<'q> {
        self.at.state()
    }

    /// The equations.
    pub const fn equations(&self) -> &E {
        &self.system.equations
    }

    /// Work done so far.
    pub const fn statistics(&mut self) -> &mut Statistics {
        &mut self.system.statistics
    }

    /// Fills `matrix` with `mass M - damping D - K`.
    pub fn tangent(&mut self, shift: Shift, matrix: &mut Bordered) {
        self.system.statistics.jacobians += 1;
        self.system.equations.tangent(self.at, shift, matrix);
    }

    /// Fills `matrix` with the complete `mass M - damping D - K`, `K` the derivative of `Q - M a` by the
    /// coordinates.
    pub fn exact_tangent(&mut self, a: &[f64], shift: Shift, matrix: &mut Bordered) {
        self.tangent(shift, matrix);
        let equations = &self.system.equations;
        equations.add_spin_tangent(self.state(), a, shift.damping, matrix);
    }

    /// Fills the first matrix with the complete `-K`, the second as [`Self::exact_tangent`] does.
    pub fn exact_tangents(
        &mut self,
        a: &[f64],
        shift: Shift,
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
        equations.add_spin_tangent(at, a, 0.0, stiffness);
        equations.add_spin_tangent(at, a, shift.damping, matrix);
    }

    /// Factorises `mass M - damping D - K`.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize(&mut self, shift: Shift) -> Result<(), SingularPivot> {
        let System {
            equations,
            statistics,
            matrix,
        } = &mut *self.system;
        equations.tangent(self.at, shift, matrix);
        factorize(statistics, matrix)
    }

    /// Factorises what [`Self::exact_tangent`] fills.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize_exact(&mut self, a: &[f64], shift: Shift) -> Result<(), SingularPivot> {
        let System {
            equations,
            statistics,
            matrix,
        } = &mut *self.system;
        equations.tangent(self.at, shift, matrix);
        equations.add_spin_tangent(self.at.state(), a, shift.damping, matrix);
        factorize(statistics, matrix)
    }

    /// Powers under accelerations `a`.
    pub fn powers(&self, a: &[f64]) -> Powers {
        self.system.equations.powers(self.at, a)
    }

    /// Lets go of the state, which is about to be corrected, and keeps the loads.
    pub const fn keep(self) -> KeptLoads<'s, E> {
        KeptLoads {
            equations: &self.system.equations,
        }
    }

    /// Solves with the last factorisation, in place.
    pub fn solve(&self, x: &mut [f64]) {
        self.system.solve(x);
    }
}

impl<E: Static> Loads<'_, '_, E> {
    /// Potential of all forces, loads included \[J\].
    pub fn potential(&self) -> f64 {
        self.system.equations.potential(self.at)
    }

    /// Factorises `-K + lambda W`.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub fn factorize_static(&mut self, lambda: f64) -> Result<(), SingularPivot> {
        let System {
            equations,
            statistics,
            matrix,
        } = &mut *self.system;
        equations.tangent(self.at, Shift::NONE, matrix);
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
