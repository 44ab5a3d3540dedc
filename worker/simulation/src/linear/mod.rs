//! Linear solvers for chains of six-wide blocks that share a thin border. No knowledge of time,
//! bodies or forces.
mod block;
mod bordered;

pub use block::{BLOCK, Block};
pub use bordered::{Bordered, SingularPivot};
