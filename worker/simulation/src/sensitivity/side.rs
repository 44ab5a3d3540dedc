//! Individual with perturbed parameters, used for differences: residuals, memory of axial laws, and gauge
//! readings.
use crate::drive::Drive;
use crate::element::bushing::Bushing;
use crate::model::forces::Terms;
use crate::model::hook::{Memory, Sampled};
use crate::model::{Individual, Machine, Ropes, Scratch};
use crate::observe::{Gradient, TorqueBy, readings, sampled, shaft, turned_by_ropes};
use crate::system::{Equations, State};

/// Individual that borrows its buffers for each evaluation.
#[derive(Clone, Debug)]
pub(super) struct Side<'a> {
    pub(super) machine: &'a Machine,
    ropes: Ropes,
    pub(super) drive: Drive,
    /// Memory of the axial laws, for each chain.
    memory: Vec<Vec<Memory>>,
}

impl<'a> Side<'a> {
    pub(super) fn new(machine: &'a Machine, ropes: Ropes, drive: Drive) -> Self {
        Self {
            machine,
            ropes,
            drive,
            memory: vec![Vec::new(); machine.chains.len()],
        }
    }

    /// Returns the law of the joints between cylinders.
    pub(super) const fn inner(&self) -> &Bushing {
        &self.ropes.joint
    }

    /// Calls `ask` with the individual, using the buffers lent to it.
    pub(super) fn within<T>(
        &mut self,
        scratch: &mut Scratch,
        ask: impl FnOnce(&mut Individual<'a>) -> T,
    ) -> T {
        let lent = std::mem::take(scratch);
        let mut individual = Individual::within(self.machine, self.ropes, self.drive, lent);
        self.exchange(&mut individual.scratch);
        let answer = ask(&mut individual);
        *scratch = individual.scratch;
        self.exchange(scratch);
        answer
    }

    fn exchange(&mut self, scratch: &mut Scratch) {
        for (own, chain) in self.memory.iter_mut().zip(&mut scratch.chains) {
            std::mem::swap(own, &mut chain.memory);
        }
    }

    /// Computes the selected terms of the residual `Q - M a`, with or without inertia, at a state whose poses
    /// are in `scratch`.
    pub(super) fn residual(
        &mut self,
        scratch: &mut Scratch,
        state: &State,
        (terms, inertia): (Terms, bool),
        out: &mut [f64],
    ) {
        self.within(scratch, |individual| {
            individual.posed_forces(state.motion(), terms, out);
            if inertia {
                individual.subtract_inertia(&state.q, &state.a, out);
            }
        });
    }

    /// Updates the memory of axial laws from an accepted state.
    pub(super) fn remember(&mut self, scratch: &mut Scratch, state: &State) {
        if self.machine.hooks.has_axial() {
            self.within(scratch, |individual| individual.remember(state));
        }
    }

    /// Returns the gauge readings \[Pa\].
    pub(super) fn readings(
        &mut self,
        scratch: &mut Scratch,
        state: &State,
        force: &mut [f64],
    ) -> [f64; 4] {
        let part = !self.machine.hooks.has_readings();
        self.within(scratch, |individual| {
            readings(individual, state, force, part)
        })
    }

    /// Returns the gauge readings \[Pa\] and, if requested, the quantities available to reading hooks; also
    /// computes the derivatives of the stress if `gradient` is given. `room` is workspace for a state.
    pub(super) fn gradient(
        &mut self,
        scratch: &mut Scratch,
        state: &State,
        (force, room): (&mut [f64], &mut State),
        (known, gradient): (bool, Option<&mut Gradient>),
    ) -> ([f64; 4], Option<Sampled>) {
        let part = !known && !self.machine.hooks.has_readings();
        self.within(scratch, |individual| {
            let stress = readings(individual, state, force, part);
            let known = known.then(|| sampled(individual, state));
            if let Some(gradient) = gradient {
                gradient.fill(individual, state, room);
            }
            (stress, known)
        })
    }

    /// Returns suspension height and crank torque; see [`shaft`].
    pub(super) fn shaft(&mut self, scratch: &mut Scratch, state: &State) -> [f64; 2] {
        self.within(scratch, |individual| shaft(individual, state))
    }

    /// Computes the derivatives of the torque with respect to the state; `room` is workspace for a state.
    pub(super) fn torque_by(
        &mut self,
        scratch: &mut Scratch,
        state: &State,
        (by, room): (&mut TorqueBy, &mut State),
    ) {
        self.within(scratch, |individual| by.fill(individual, state, room));
    }

    /// Returns the crank torque caused by the force of the back ropes alone [N m].
    pub(super) fn turned_by_ropes(&mut self, scratch: &mut Scratch, state: &State) -> f64 {
        self.within(scratch, |individual| turned_by_ropes(individual, state))
    }

    /// Returns the force of the rope's end on the back head, in the beam frame \[N\].
    pub(super) fn anchor_pull(&mut self, scratch: &mut Scratch, state: &State) -> [f64; 2] {
        self.within(scratch, |individual| individual.anchor_pull(state.motion()))
    }
}
