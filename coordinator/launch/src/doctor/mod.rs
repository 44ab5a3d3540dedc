//! What keeps workers from a coordinator: from either side, the first layer that fails, and the remedy.
//!
//! Knows the link and one message; takes no part in a run, and a coordinator is told nothing of it.
mod check;
mod classify;
mod dial;
mod listen;
mod program;

pub use check::{Check, Layer};
pub use dial::dial;
pub use listen::listen;
pub use program::program;
