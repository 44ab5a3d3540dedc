//! Linearisation of the equations of one solved stage of a time step.
use crate::integrator::stepper::Stages;
use crate::linear::{Bordered, SingularPivot};
use crate::math::vector::add_scaled;
use crate::model::chain::unit_loads::UnitLoads;
use crate::model::extension::MemoryDerivatives;
use crate::model::{ForceBuffers, RopeMachine};
use crate::system::{Equations, State, StateShift, System};

/// Linearised stage of a time step: state, matrix `-K'`, factor of `S`, and the buffers of the force
/// evaluation.
#[derive(Debug)]
pub(super) struct Linearized {
    /// State of the stage, including accelerations.
    pub(super) state: State,
    /// Matrix `-K'`: derivative of the residual `M(q) a - Q` with respect to the coordinates, including that
    /// of `M(q) a`.
    pub(super) stiffness: Bordered,
    /// Factorisation of the iteration matrix `S = M / c^2 - D / c - K'`, or of `-K` at rest.
    pub(super) factor: Bordered,
    /// Cylinder poses, joint loads and contact at the stage.
    pub(super) scratch: ForceBuffers,
    /// Loads of the rope joints per unit of each coefficient, for motion in the plane and only if a requested
    /// derivative needs them: one element per chain, or none.
    pub(super) units: Vec<UnitLoads>,
    /// Derivatives that concern the memory of the axial laws, one list per chain; see [`Chain::memory_derivatives`].
    ///
    /// [`Chain::memory_derivatives`]: crate::model::chain::Chain::memory_derivatives
    pub(super) memory: Vec<Vec<MemoryDerivatives>>,
}

impl Linearized {
    pub(super) fn new(equations: &RopeMachine<'_>, state: &State, units: bool) -> Self {
        let chains = equations.machine.chains.iter();
        Self {
            state: state.clone(),
            stiffness: equations.matrix(),
            factor: equations.matrix(),
            scratch: ForceBuffers::new(equations.machine),
            memory: vec![Vec::new(); chains.len()],
            units: chains.filter(|_| units).map(UnitLoads::new).collect(),
        }
    }

    /// Linearises the equations at a static equilibrium and factorises `-K`.
    ///
    /// # Errors
    /// [`SingularPivot`] naming the unknown whose pivot vanished.
    pub(super) fn rest(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        state: &State,
        force: &mut [f64],
    ) -> Result<(), SingularPivot> {
        self.state.clone_from(state);
        self.linearize(system, StateShift::NONE, force)
    }

    /// Linearises and factorises stage `i` of the step between two states.
    ///
    /// # Errors
    /// [`SingularPivot`] naming the unknown whose pivot vanished.
    pub(super) fn stage(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        (i, stages): (usize, Stages<'_>),
        [from, to]: [&State; 2],
        force: &mut [f64],
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
                add_scaled(&mut state.q, h * weight, v);
            }
            add_scaled(&mut state.q, c, v);
        } else {
            self.state.clone_from(to);
        }
        let damping = 1.0 / c;
        let shift = StateShift {
            mass: damping * damping,
            damping,
        };
        self.linearize(system, shift, force)
    }

    fn linearize(
        &mut self,
        system: &mut System<RopeMachine<'_>>,
        shift: StateShift,
        force: &mut [f64],
    ) -> Result<(), SingularPivot> {
        // what columns cost is no work of the run's
        let kept = system.statistics;
        let State { a, .. } = &self.state;
        let mut loads = system.forces(self.state.motion(), force);
        let matrices = [&mut self.stiffness, &mut self.factor];
        loads.exact_tangents(a, shift, matrices);
        system.statistics = kept;
        let individual = &mut system.equations;
        individual.unit_loads(self.state.motion(), &mut self.units);
        if individual.machine.extensions.has_axial() {
            individual.memory_derivatives(self.state.motion(), &self.units, &mut self.memory);
        }
        std::mem::swap(&mut individual.scratch, &mut self.scratch);
        // the run's past stays with the run
        let chains = individual.scratch.chains.iter_mut();
        for (run, stage) in chains.zip(&mut self.scratch.chains) {
            std::mem::swap(&mut run.memory, &mut stage.memory);
        }
        self.factor.factorize_closed()
    }
}
