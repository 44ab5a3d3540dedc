//! A machine beside the one that runs: what its stages, its past and its gauges say where a parameter is
//! a little off.
use crate::drive::Drive;
use crate::model::hook::Memory;
use crate::model::{Individual, Machine, Ropes, Scratch};
use crate::observe::readings;
use crate::system::{Equations, State, StateRef};

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

    /// The individual with buffers lent to it.
    fn within<T>(
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

    /// Residual `Q - M a`.
    pub(super) fn residual(
        &mut self,
        scratch: &mut Scratch,
        at: StateRef<'_>,
        a: &[f64],
        out: &mut [f64],
    ) {
        self.within(scratch, |individual| {
            individual.forces(at, out);
            individual.subtract_inertia(at.q, a, out);
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
}
