//! Layout of the state vector: the index of each coordinate.
//!
//! Blocks of three (motion in the plane) or six coordinates (in space): `[rod | back cylinders, crossbeam to
//! anchor | suspension | front cylinders, suspension to anchor]`, then the border `[beam angle | modal
//! coordinates]`. Rod and suspension use only the first coordinate of their block; the others are locked.
//!
//! With twin ropes, rod and suspension each carry two chains and therefore cannot belong to the blocks of one
//! chain: `[back cylinders at +b | at -b | front cylinders at +b | at -b]`, then the border `[suspension
//! height, rod angle | beam angle | modal coordinates]`. The suspension comes first in the border because the
//! longest chains couple to nothing else before they reach the front head.
use crate::linear::{BLOCK, Bordered};

/// Maximum number of head modes in a simulation.
pub(crate) const MAX_MODES: usize = 24;

/// Set of coordinates of a cylinder.
///
/// A machine that is symmetric about its plane, and loaded in it, stays in it exactly: every force out of the
/// plane has a factor that is zero. Three coordinates per cylinder then give the same result as six, at a
/// quarter of the cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Motion {
    /// Motion in the machine's plane: position and angle `(x, y, psi)`.
    Plane,
    /// Motion in space: position and three angles `(x, y, z, phi, theta, psi)`.
    Space,
}

impl Motion {
    /// Returns the number of coordinates per cylinder.
    pub const fn width(self) -> usize {
        match self {
            Self::Plane => 3,
            Self::Space => BLOCK,
        }
    }

    /// Returns for each of the six spatial coordinates of a cylinder whether this set includes it.
    pub const fn kept(self) -> &'static [usize] {
        match self {
            Self::Plane => &[0, 1, 5],
            Self::Space => &[0, 1, 2, 3, 4, 5],
        }
    }
}

/// Counts of cylinders, modes and ropes of a model, from which the indices of its coordinates follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Number of cylinders of each back rope.
    pub back: usize,
    /// Number of cylinders of each front rope.
    pub front: usize,
    /// Number of modes of the back head, including out-of-plane modes.
    pub modes: usize,
    /// Number of out-of-plane modes; they are the last of the `modes` head modes.
    pub sway: usize,
    /// Number of parallel ropes on each head: one or two.
    pub ropes: usize,
    /// Set of coordinates of each cylinder: in the plane or in space.
    pub motion: Motion,
}

impl Layout {
    /// Returns whether each head carries two parallel ropes.
    pub const fn twins(&self) -> bool {
        self.ropes > 1
    }

    /// Returns the number of matrix blocks of each rope chain: its cylinders and, for a single rope, the
    /// rigid body at its base end.
    pub fn chains(&self) -> Vec<usize> {
        if self.twins() {
            vec![self.back, self.back, self.front, self.front]
        } else {
            vec![1 + self.back, 1 + self.front]
        }
    }

    /// Returns the index of the block that the first cylinder of a chain occupies in the state vector; the
    /// chains of the back head come first.
    pub const fn first(&self, chain: usize) -> usize {
        if self.twins() {
            [0, self.back, 2 * self.back, 2 * self.back + self.front][chain]
        } else {
            [1, 2 + self.back][chain]
        }
    }

    /// Returns the number of border coordinates before the beam angle.
    const fn lead(&self) -> usize {
        if self.twins() { 2 } else { 0 }
    }

    /// Allocates a zero iteration matrix for this layout.
    pub fn matrix(&self) -> Bordered {
        let border = 1 + self.modes;
        match self.motion {
            Motion::Plane => Bordered::plane(&self.chains(), [self.lead(), border]),
            Motion::Space => Bordered::space(&self.chains(), [self.lead(), border]),
        }
    }

    /// Returns the number of blocks (cylinders and their base bodies) in the state vector before the border.
    pub const fn blocks(&self) -> usize {
        if self.twins() {
            2 * (self.back + self.front)
        } else {
            2 + self.back + self.front
        }
    }

    /// Returns the number of coordinates of the state vector, including locked ones.
    pub const fn len(&self) -> usize {
        self.beam() + 1 + self.modes
    }

    /// Returns `false`: a layout always has coordinates.
    pub const fn is_empty(&self) -> bool {
        false
    }

    /// Returns the block indices of rod and suspension; `None` for twin ropes, where both are in the border.
    pub const fn base_blocks(&self) -> Option<[usize; 2]> {
        if self.twins() {
            None
        } else {
            Some([0, 1 + self.back])
        }
    }

    /// Returns whether a coordinate is locked: one without a degree of freedom, which only fills up the block
    /// of rod or suspension.
    pub fn is_locked(&self, index: usize) -> bool {
        let width = self.motion.width();
        let base = self
            .base_blocks()
            .is_some_and(|at| at.contains(&(index / width)));
        base && index < self.beam() && !index.is_multiple_of(width)
    }

    /// Returns the index of the rod angle in the state vector.
    pub const fn rod(&self) -> usize {
        if self.twins() {
            self.blocks() * self.motion.width() + 1
        } else {
            0
        }
    }

    /// Returns the index of the suspension height in the state vector.
    pub const fn suspension(&self) -> usize {
        if self.twins() {
            self.blocks() * self.motion.width()
        } else {
            (1 + self.back) * self.motion.width()
        }
    }

    /// Returns the index of the beam angle in the state vector.
    pub const fn beam(&self) -> usize {
        self.blocks() * self.motion.width() + self.lead()
    }

    /// Returns the number of in-plane head modes, which precede the out-of-plane modes.
    pub const fn plane_modes(&self) -> usize {
        self.modes - self.sway
    }

    /// Returns the index of modal coordinate `k` in the state vector.
    pub const fn mode(&self, k: usize) -> usize {
        self.beam() + 1 + k
    }

    /// Returns the name of a coordinate for use in messages.
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
