//! Buffers of one evaluation of a machine's forces: poses, joint loads, contact.
use crate::math::spline::sum::WeightedSplines;
use crate::model::chain::state::ChainState;
use crate::model::machine::Machine;

/// Buffers of a force evaluation: poses, loads and head deflection.
#[derive(Clone, Debug, Default)]
pub struct ForceBuffers {
    /// Cylinder poses and joint loads of each chain: back chains, then front chains.
    pub chains: Vec<ChainState>,
    /// Deflection of the back head's arc under each back rope.
    pub deflection: Vec<WeightedSplines>,
}

impl ForceBuffers {
    /// Allocates the buffers of a force evaluation for a machine.
    pub fn new(machine: &Machine) -> Self {
        Self {
            chains: machine.chains.iter().map(ChainState::new).collect(),
            deflection: vec![WeightedSplines::default(); machine.faces.len()],
        }
    }

    /// Returns the deepest penetration of a rope into a head \[m\].
    pub(crate) fn max_penetration(&self) -> f64 {
        self.chains
            .iter()
            .fold(0.0, |deepest, chain| deepest.max(chain.deepest))
    }
}
