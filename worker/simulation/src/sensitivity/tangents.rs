//! One stage, taken as solved, linearised.
use super::source::add;
use crate::integrator::stepper::Stages;
use crate::linear::{Bordered, SingularPivot};
use crate::system::{Equations, Shift, State, System};

/// State of a stage, its `-K'` and the factor of its `S`.
#[derive(Debug)]
pub(super) struct Tangents {
    /// The stage's state under its accelerations.
    pub(super) state: State,
    /// `-K'`, which holds the derivatives of `M(q) a` too.
    pub(super) stiffness: Bordered,
    /// Factor of `S = M / c^2 - D / c - K'`, or of `-K` at rest.
    pub(super) factor: Bordered,
    room: Bordered,
    /// How many were made.
    pub(super) factorizations: u64,
}

impl Tangents {
    /// Allocates.
    pub(super) fn new<E: Equations>(equations: &E, state: &State) -> Self {
        Self {
            state: state.clone(),
            stiffness: equations.matrix(),
            factor: equations.matrix(),
            room: equations.matrix(),
            factorizations: 0,
        }
    }

    /// Factorises `-K` at an equilibrium.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub(super) fn rest<E: Equations>(
        &mut self,
        system: &mut System<E>,
        state: &State,
        room: &mut [f64],
    ) -> Result<(), SingularPivot> {
        self.state.clone_from(state);
        self.linearize(system, Shift::NONE, room)
    }

    /// Linearises stage `i` of the step between two states.
    ///
    /// # Errors
    /// The unknown whose pivot vanished.
    pub(super) fn stage<E: Equations>(
        &mut self,
        system: &mut System<E>,
        (i, stages): (usize, Stages<'_>),
        [from, to]: [&State; 2],
        room: &mut [f64],
    ) -> Result<(), SingularPivot> {
        let h = to.t - from.t;
        let c = stages.tableau.diagonal * h;
        if let Some((v, a)) = stages.rates.get(i) {
            let state = &mut self.state;
            state.t = from.t + stages.tableau.nodes[i] * h;
            state.q.copy_from_slice(&from.q);
            state.v.copy_from_slice(v);
            state.a.copy_from_slice(a);
            for (weight, (v, _)) in stages.tableau.rows[i].iter().zip(stages.rates) {
                add(&mut state.q, h * weight, v);
            }
            add(&mut state.q, c, v);
        } else {
            self.state.clone_from(to);
        }
        let damping = 1.0 / c;
        let shift = Shift {
            mass: damping * damping,
            damping,
        };
        self.linearize(system, shift, room)
    }

    fn linearize<E: Equations>(
        &mut self,
        system: &mut System<E>,
        shift: Shift,
        room: &mut [f64],
    ) -> Result<(), SingularPivot> {
        // what columns cost is no work of the run's
        let kept = system.statistics;
        let State { a, .. } = &self.state;
        let mut loads = system.forces(self.state.motion(), room);
        let matrices = [&mut self.stiffness, &mut self.room, &mut self.factor];
        loads.exact_tangents(a, shift, matrices);
        system.statistics = kept;
        self.factorizations += 1;
        self.factor.factorize()
    }
}
