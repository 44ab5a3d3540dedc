//! Where each coordinate lives in a state vector.
//!
//! Blocks of three (motion in the plane) or six (in space): `[rod | back cylinders, crossbeam to anchor | suspension | front cylinders,
//! suspension to anchor]`, then the border `[beam angle | modal coordinates]`. Rod and suspension
//! use only their first entry; the others are locked.
//!
//! With twin ropes rod and suspension carry two chains each, so that neither can be a block of one:
//! `[back cylinders at +b | at -b | front cylinders at +b | at -b]`, then the border
//! `[suspension height, rod angle | beam angle | modal coordinates]`. The suspension comes first
//! because the longest chains touch nothing else before they reach the front head.
use crate::linear::{BLOCK, Bordered};

/// Most modes a head may have in a simulation.
pub(crate) const MAX_MODES: usize = 24;

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
    /// Modes of the back head, those out of its plane included.
    pub modes: usize,
    /// How many of those, the last ones, lead out of the plane.
    pub sway: usize,
    /// Ropes that lie side by side on each head: one or two.
    pub ropes: usize,
    /// Coordinates of a cylinder.
    pub motion: Motion,
}

impl Layout {
    /// Whether two ropes lie side by side.
    pub const fn twins(&self) -> bool {
        self.ropes > 1
    }

    /// Blocks per chain: the rigid body at its free end, unless that has two chains; its cylinders.
    pub fn chains(&self) -> Vec<usize> {
        if self.twins() {
            vec![self.back, self.back, self.front, self.front]
        } else {
            vec![1 + self.back, 1 + self.front]
        }
    }

    /// Block of the first cylinder of a chain: those of the back ropes come first.
    pub const fn first(&self, chain: usize) -> usize {
        if self.twins() {
            [0, self.back, 2 * self.back, 2 * self.back + self.front][chain]
        } else {
            [1, 2 + self.back][chain]
        }
    }

    /// Unknowns of the border before the beam angle.
    const fn lead(&self) -> usize {
        if self.twins() { 2 } else { 0 }
    }

    /// An empty matrix of this shape: allocates.
    pub fn matrix(&self) -> Bordered {
        let border = 1 + self.modes;
        match self.motion {
            Motion::Plane => Bordered::plane(&self.chains(), [self.lead(), border]),
            Motion::Space => Bordered::space(&self.chains(), [self.lead(), border]),
        }
    }

    /// Number of blocks.
    pub const fn blocks(&self) -> usize {
        if self.twins() {
            2 * (self.back + self.front)
        } else {
            2 + self.back + self.front
        }
    }

    /// Number of coordinates, locked ones included.
    pub const fn len(&self) -> usize {
        self.beam() + 1 + self.modes
    }

    /// Whether there is nothing.
    pub const fn is_empty(&self) -> bool {
        false
    }

    /// Blocks of rod and suspension, where they are blocks.
    pub const fn base_blocks(&self) -> Option<[usize; 2]> {
        if self.twins() {
            None
        } else {
            Some([0, 1 + self.back])
        }
    }

    /// Whether a coordinate is none: it fills up the block of rod or suspension.
    pub fn is_locked(&self, index: usize) -> bool {
        let width = self.motion.width();
        let base = self
            .base_blocks()
            .is_some_and(|at| at.contains(&(index / width)));
        base && index < self.beam() && !index.is_multiple_of(width)
    }

    /// Index of the rod angle.
    pub const fn rod(&self) -> usize {
        if self.twins() {
            self.blocks() * self.motion.width() + 1
        } else {
            0
        }
    }

    /// Index of the suspension height.
    pub const fn suspension(&self) -> usize {
        if self.twins() {
            self.blocks() * self.motion.width()
        } else {
            (1 + self.back) * self.motion.width()
        }
    }

    /// Index of the beam angle.
    pub const fn beam(&self) -> usize {
        self.blocks() * self.motion.width() + self.lead()
    }

    /// Modes that stay in the plane: the first ones.
    pub const fn plane_modes(&self) -> usize {
        self.modes - self.sway
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
        if index == self.rod() {
            return "rod angle".to_owned();
        }
        if index == self.suspension() {
            return "suspension height".to_owned();
        }
        let width = self.motion.width();
        let (block, k) = (index / width, self.motion.kept()[index % width]);
        let chain = (1..2 * self.ropes)
            .rfind(|&chain| self.first(chain) <= block)
            .unwrap_or(0);
        let rope = if chain < self.ropes { "back" } else { "front" };
        let side = match (self.twins(), chain % self.ropes) {
            (false, _) => "",
            (true, 0) => " at +b",
            (true, _) => " at -b",
        };
        let cylinder = (block + 1).saturating_sub(self.first(chain));
        format!("{} of {rope} rope{side} cylinder {cylinder}", NAMES[k])
    }
}
