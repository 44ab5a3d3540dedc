//! Individual with perturbed parameters, used for differences: residuals, memory of axial laws, and gauge
//! readings.
use crate::drive::Drive;
use crate::model::extension::{Memory, SampleState};
use crate::model::forces::Terms;
use crate::model::{ForceBuffers, Machine, RopeMachine, Ropes};
use crate::observe::{
    Gradient, TorqueBy, readings, recovered_stress, sampled, shaft, turned_by_ropes,
};
use crate::system::{Equations, State};

/// Individual with perturbed parameters that borrows its buffers for each evaluation.
#[derive(Clone, Debug)]
pub(super) struct PerturbedModel<'a> {
    pub(super) machine: &'a Machine,
    ropes: Ropes,
    pub(super) drive: Drive,
    /// Memory of the axial laws in the joints of each chain.
    memory: Vec<Vec<Memory>>,
}

impl<'a> PerturbedModel<'a> {
    pub(super) fn new(machine: &'a Machine, ropes: Ropes, drive: Drive) -> Self {
        Self {
            machine,
            ropes,
            drive,
            memory: vec![Vec::new(); machine.chains.len()],
        }
    }

    pub(super) const fn ropes(&self) -> &Ropes {
        &self.ropes
    }

    /// Calls `ask` with the equations of motion of the perturbed individual, which borrow the given buffers
    /// for the duration of the call.
    pub(super) fn with_buffers<T>(
        &mut self,
        scratch: &mut ForceBuffers,
        ask: impl FnOnce(&mut RopeMachine<'a>) -> T,
    ) -> T {
        let lent = std::mem::take(scratch);
        let mut individual = RopeMachine::within(self.machine, self.ropes, self.drive, lent);
        self.exchange(&mut individual.scratch);
        let answer = ask(&mut individual);
        *scratch = individual.scratch;
        self.exchange(scratch);
        answer
    }

    fn exchange(&mut self, scratch: &mut ForceBuffers) {
        for (own, chain) in self.memory.iter_mut().zip(&mut scratch.chains) {
            std::mem::swap(own, &mut chain.memory);
        }
    }

    /// Computes the selected terms of the residual `Q - M a`, with or without inertia, at a state whose poses
    /// are in `scratch`.
    pub(super) fn residual(
        &mut self,
        scratch: &mut ForceBuffers,
        state: &State,
        (terms, inertia): (Terms, bool),
        out: &mut [f64],
    ) {
        self.with_buffers(scratch, |individual| {
            individual.posed_forces(state.motion(), terms, out);
            if inertia {
                individual.subtract_inertia(&state.q, &state.a, out);
            }
        });
    }

    /// Returns the memory of the axial laws in all joints, by chain.
    pub(super) fn memory(&self) -> &[Vec<Memory>] {
        &self.memory
    }

    /// Takes over the memory of another machine.
    pub(super) fn remember_as(&mut self, other: &Self) {
        self.memory.clone_from(&other.memory);
    }

    /// Updates the memory of axial laws from an accepted state.
    pub(super) fn remember(&mut self, scratch: &mut ForceBuffers, state: &State) {
        if self.machine.extensions.has_axial() {
            self.with_buffers(scratch, |individual| individual.update_memory(state));
        }
    }

    /// Returns the gauge readings of the perturbed individual at a state \[Pa\].
    pub(super) fn readings(
        &mut self,
        scratch: &mut ForceBuffers,
        state: &State,
        force: &mut [f64],
    ) -> [f64; 4] {
        let part = !self.machine.extensions.has_readings();
        self.with_buffers(scratch, |individual| {
            readings(individual, state, force, part)
        })
    }

    /// Returns the stress at the gauges before the measuring chain \[Pa\] and, if requested or if the individual has
    /// a measuring chain, what its stages may use; also computes the derivatives of the gauge stress if `gradient`
    /// is given. `room` is workspace for a state.
    pub(super) fn gradient(
        &mut self,
        scratch: &mut ForceBuffers,
        state: &State,
        (force, room): (&mut [f64], &mut State),
        (known, gradient): (bool, Option<&mut Gradient>),
    ) -> ([f64; 4], Option<SampleState>) {
        let extensions = &self.machine.extensions;
        let part = !known && !extensions.readings_need_loads();
        let known = known || extensions.has_readings();
        self.with_buffers(scratch, |individual| {
            let stress = recovered_stress(individual, state, force, part);
            let known = known.then(|| sampled(individual, state));
            if let Some(gradient) = gradient {
                gradient.fill(individual, state, room);
            }
            (stress, known)
        })
    }

    /// Returns suspension height and crank torque; see [`shaft`].
    pub(super) fn shaft(&mut self, scratch: &mut ForceBuffers, state: &State) -> [f64; 2] {
        self.with_buffers(scratch, |individual| shaft(individual, state))
    }

    /// Computes the derivatives of the torque with respect to the state; `room` is workspace for a state.
    pub(super) fn torque_by(
        &mut self,
        scratch: &mut ForceBuffers,
        state: &State,
        (by, room): (&mut TorqueBy, &mut State),
    ) {
        self.with_buffers(scratch, |individual| by.fill(individual, state, room));
    }

    /// Returns the crank torque caused by the force of the back ropes alone [N m].
    pub(super) fn turned_by_ropes(&mut self, scratch: &mut ForceBuffers, state: &State) -> f64 {
        self.with_buffers(scratch, |individual| turned_by_ropes(individual, state))
    }

    /// Returns the force of the rope's end on the back head, in the beam frame \[N\].
    pub(super) fn anchor_pull(&mut self, scratch: &mut ForceBuffers, state: &State) -> [f64; 2] {
        self.with_buffers(scratch, |individual| individual.anchor_pull(state.motion()))
    }
}
