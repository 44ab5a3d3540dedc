//! Where each coordinate lives in a state vector.
//!
//! Blocks of six: `[rod | back cylinders, crossbeam to anchor | suspension | front cylinders,
//! suspension to anchor]`, then the border `[beam angle | modal coordinates]`. Rod and suspension
//! use only their first entry; the other five are locked.
use crate::linear::BLOCK;

/// Sizes of a model and the indices that follow from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Cylinders of the back rope.
    pub back: usize,
    /// Cylinders of the front rope.
    pub front: usize,
    /// Modes of the back head.
    pub modes: usize,
}

impl Layout {
    /// Blocks per chain: the rigid body at its free end, then its cylinders.
    pub const fn chains(&self) -> [usize; 2] {
        [1 + self.back, 1 + self.front]
    }

    /// Number of blocks.
    pub const fn blocks(&self) -> usize {
        2 + self.back + self.front
    }

    /// Number of coordinates, locked ones included.
    pub const fn len(&self) -> usize {
        self.blocks() * BLOCK + 1 + self.modes
    }

    /// Whether there is nothing.
    pub const fn is_empty(&self) -> bool {
        false
    }

    /// Block of a chain's free end: the rod (0) or the suspension (1).
    pub const fn base_block(&self, chain: usize) -> usize {
        if chain == 0 { 0 } else { 1 + self.back }
    }

    /// Index of the rod angle.
    pub const fn rod(&self) -> usize {
        0
    }

    /// Index of the suspension height.
    pub const fn suspension(&self) -> usize {
        (1 + self.back) * BLOCK
    }

    /// Index of the beam angle.
    pub const fn beam(&self) -> usize {
        self.blocks() * BLOCK
    }

    /// Index of modal coordinate `k`.
    pub const fn mode(&self, k: usize) -> usize {
        self.beam() + 1 + k
    }

    /// What a coordinate is called in messages.
    pub fn describe(&self, index: usize) -> String {
        const NAMES: [&str; BLOCK] = ["x", "y", "z", "twist", "pitch angle", "plane angle"];
        if index >= self.beam() {
            return if index == self.beam() {
                "beam angle".to_owned()
            } else {
                format!("head mode {}", index - self.beam())
            };
        }
        let (block, k) = (index / BLOCK, index % BLOCK);
        let second = self.base_block(1);
        match block {
            0 => "rod angle".to_owned(),
            b if b == second => "suspension height".to_owned(),
            b if b < second => format!("{} of back rope cylinder {b}", NAMES[k]),
            b => format!("{} of front rope cylinder {}", NAMES[k], b - second),
        }
    }
}
