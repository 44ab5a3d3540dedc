//! Linear solvers for chains of blocks (three or six wide) that share a thin border. Independent of time,
//! bodies and forces.
mod block;
mod blocks;
mod bordered;
mod chains;
mod entry;
mod lanes;

pub use block::{BLOCK, MatrixBlock};
pub use blocks::{Blocks, SingularPivot};
pub use bordered::Bordered;
pub use entry::{LANES, Lanes, MatrixEntry};
