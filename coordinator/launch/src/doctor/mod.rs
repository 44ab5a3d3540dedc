//! Diagnosis of connection problems between workers and coordinator: from either side, the first layer that
//! fails, with the remedy.
//!
//! Uses only the link and one message; takes no part in a run, and leaves no trace at the coordinator.
mod check;
mod classify;
mod dial;
mod listen;
mod program;

pub use check::{Check, Layer};
pub use dial::dial;
pub use listen::listen;
pub use program::program;
