//! Control socket of an open run: lists workers and drains them.
//!
//! The socket lies in the run folder, accessible to the owner only, and speaks JSON lines: one request, one
//! answer ([`words`]). It gives access to the workers of a run and to nothing else.
mod client;
mod path;
mod server;
pub mod words;

pub use client::{ControlError, ask};
pub use path::SOCKET;
pub(super) use server::{Asked, Control};
