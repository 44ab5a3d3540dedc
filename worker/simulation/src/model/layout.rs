//! Where each coordinate lives in a state vector.
//!
//! Blocks of three (motion in the plane) or six (in space): `[rod | back cylinders, crossbeam to anchor | suspension | front cylinders,
//! suspension to anchor]`, then the border `[beam angle | modal coordinates]`. Rod and suspension
//! use only their first entry; the others are locked.
use crate::linear::{BLOCK, Bordered};

/// Which coordinates a cylinder has.
///
/// A machine that is symmetric about its plane, and loaded in it, stays in it exactly: every force
/// out of the plane is a product with zero. Then three coordinates per cylinder tell the same as
/// six, at a quarter of the work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Place and angle in the machine's plane: `(x, y, psi)`.
    Plane,
    /// Place and three angles: `(x, y, z, phi, theta, psi)`.
    Space,
}

impl Motion {
    /// Number of coordinates of a cylinder.
    pub const fn width(self) -> usize {
        match self {
            Self::Plane => 3,
            Self::Space => BLOCK,
        }
    }

    /// Which of the six coordinates a cylinder has, in their order.
    pub const fn kept(self) -> &'static [usize] {
        match self {
            Self::Plane => &[0, 1, 5],
            Self::Space => &[0, 1, 2, 3, 4, 5],
        }
    }
}

/// Sizes of a model and the indices that follow from them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Cylinders of the back rope.
    pub back: usize,
    /// Cylinders of the front rope.
    pub front: usize,
    /// Modes of the back head.
    pub modes: usize,
    /// Coordinates of a cylinder.
    pub motion: Motion,
}

impl Layout {
    /// Blocks per chain: the rigid body at its free end, then its cylinders.
    pub const fn chains(&self) -> [usize; 2] {
        [1 + self.back, 1 + self.front]
    }

    /// An empty matrix of this shape: allocates.
    pub fn matrix(&self) -> Bordered {
        let border = 1 + self.modes;
        match self.motion {
            Motion::Plane => Bordered::plane(&self.chains(), border),
            Motion::Space => Bordered::space(&self.chains(), border),
        }
    }

    /// Number of blocks.
    pub const fn blocks(&self) -> usize {
        2 + self.back + self.front
    }

    /// Number of coordinates, locked ones included.
    pub const fn len(&self) -> usize {
        self.blocks() * self.motion.width() + 1 + self.modes
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
        (1 + self.back) * self.motion.width()
    }

    /// Index of the beam angle.
    pub const fn beam(&self) -> usize {
        self.blocks() * self.motion.width()
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
        let width = self.motion.width();
        let (block, k) = (index / width, self.motion.kept()[index % width]);
        let second = self.base_block(1);
        match block {
            0 => "rod angle".to_owned(),
            b if b == second => "suspension height".to_owned(),
            b if b < second => format!("{} of back rope cylinder {b}", NAMES[k]),
            b => format!("{} of front rope cylinder {}", NAMES[k], b - second),
        }
    }
}
