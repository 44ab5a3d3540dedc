//! A machine beside the one that runs: what its stages, its past and its gauges say where a parameter is
//! a little off.
use crate::drive::Drive;
use crate::element::bushing::Bushing;
use crate::model::forces::Terms;
use crate::model::hook::{Memory, Sampled};
use crate::model::{Individual, Machine, Ropes, Scratch};
use crate::observe::{Gradient, TorqueBy, readings, sampled, shaft, turned_by_ropes};
use crate::system::{Equations, State};

/// An individual without buffers of its own.
#[derive(Clone, Debug)]
pub(super) struct Side<'a> {
    pub(super) machine: &'a Machine,
    ropes: Ropes,
    pub(super) drive: Drive,
    /// What its laws along the ropes remember, chain by chain.
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

    /// Law of the joints between its cylinders.
    pub(super) const fn inner(&self) -> &Bushing {
        &self.ropes.joint
    }

    /// The individual with buffers lent to it.
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

    /// Some terms of the residual `Q - M a`, inertia among them or not, at a state whose poses are in
    /// `scratch`.
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

    /// Lets laws with a past remember an accepted state.
    pub(super) fn remember(&mut self, scratch: &mut Scratch, state: &State) {
        if self.machine.hooks.has_axial() {
            self.within(scratch, |individual| individual.remember(state));
        }
    }

    /// What the gauges read \[Pa\].
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

    /// The same with what further readings may know, if that is asked for, and the derivatives by the state
    /// where the gauges have them; `room` is for a state.
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

    /// What is read beside the gauges, as [`shaft`] says.
    pub(super) fn shaft(&mut self, scratch: &mut Scratch, state: &State) -> [f64; 2] {
        self.within(scratch, |individual| shaft(individual, state))
    }

    /// Derivatives of the torque by the state; `room` is for a state.
    pub(super) fn torque_by(
        &mut self,
        scratch: &mut Scratch,
        state: &State,
        (by, room): (&mut TorqueBy, &mut State),
    ) {
        self.within(scratch, |individual| by.fill(individual, state, room));
    }

    /// What the back ropes' pull alone turns the crank with [N m].
    pub(super) fn turned_by_ropes(&mut self, scratch: &mut Scratch, state: &State) -> f64 {
        self.within(scratch, |individual| turned_by_ropes(individual, state))
    }

    /// Force of the end of the rope on the back head, in the beam frame \[N\].
    pub(super) fn anchor_pull(&mut self, scratch: &mut Scratch, state: &State) -> [f64; 2] {
        self.within(scratch, |individual| individual.anchor_pull(state.motion()))
    }
}
