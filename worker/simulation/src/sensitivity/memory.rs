//! Derivatives of what axial laws remember with respect to the columns of one block.
//!
//! For motion in the plane, where memory is differentiated with the state: at each step the next memory follows from
//! the extension of the joint, from the memory before and, for a parameter of the law, from differences.
use super::linearized::Linearized;
use crate::linear::Lanes;
use crate::model::chain::Chain;
use crate::model::extension::Memory;

/// Derivatives of the memory of each law in each joint between two cylinders, by chain; one lane per column.
#[derive(Clone, Debug)]
pub(super) struct MemoryColumns {
    chains: Vec<Vec<[Lanes; 2]>>,
}

impl MemoryColumns {
    /// Creates derivatives that are zero.
    pub(super) fn new(chains: usize) -> Self {
        Self {
            chains: vec![Vec::new(); chains],
        }
    }

    /// Adds the forces at a stage per unit of each column that follow from the memory.
    pub(super) fn add_forces(&self, at: &Linearized, chains: &[Chain], right: &mut [Lanes]) {
        let stage = at.units.iter().zip(&at.memory).zip(chains);
        for (own, ((units, by), chain)) in self.chains.iter().zip(stage) {
            if own.is_empty() {
                continue;
            }
            let laws = own.len() / (chain.count - 1);
            let tension = |k: usize| {
                let mut sum = Lanes::default();
                let range = k * laws..(k + 1) * laws;
                for (own, by) in own[range.clone()].iter().zip(&by[range]) {
                    sum += own[0] * by.force[0] + own[1] * by.force[1];
                }
                sum
            };
            units.add_tensions(tension, &mut right[chain.range()]);
        }
    }

    /// Advances the derivatives to the end of a step, at which the coordinates have the derivatives `moved`; laws do not
    /// depend on the columns' parameters.
    pub(super) fn advance(&mut self, end: &Linearized, chains: &[Chain], moved: &[Lanes]) {
        let stage = end.units.iter().zip(&end.memory).zip(chains);
        for (own, ((units, by), chain)) in self.chains.iter_mut().zip(stage) {
            own.resize(by.len(), [Lanes::default(); 2]);
            let laws = by.len() / (chain.count - 1);
            for (place, (own, by)) in own.iter_mut().zip(by).enumerate() {
                let stretched = units.extension_by(place / laws, &moved[chain.range()]);
                let before = *own;
                for (k, own) in own.iter_mut().enumerate() {
                    *own = stretched * by.by_strain[k]
                        + before[0] * by.by_memory[0][k]
                        + before[1] * by.by_memory[1][k];
                }
            }
        }
    }

    /// Adds `weight` times the memory of a machine, all of whose joints `memory` lists by chain, to one lane.
    pub(super) fn add(
        &mut self,
        lane: usize,
        weight: f64,
        memory: &[Vec<Memory>],
        chains: &[Chain],
    ) {
        for ((own, memory), chain) in self.chains.iter_mut().zip(memory).zip(chains) {
            let laws = own.len() / (chain.count - 1);
            // without the joint at the base
            for (own, memory) in own.iter_mut().zip(memory.iter().skip(laws)) {
                for (own, value) in own.iter_mut().zip(memory) {
                    own.0[lane] += weight * value;
                }
            }
        }
    }

    /// Sets the derivatives of one lane to zero.
    pub(super) fn clear(&mut self, lane: usize) {
        for own in self.chains.iter_mut().flatten().flatten() {
            own.0[lane] = 0.0;
        }
    }
}
