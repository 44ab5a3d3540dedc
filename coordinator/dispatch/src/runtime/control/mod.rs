//! The socket of a running run: who works, and taking workers out of the work.
//!
//! It lies in the run folder, for the owner alone, and speaks lines of JSON: one question, one answer
//! ([`words`]). It knows no more of a run than its workers.
mod client;
mod path;
mod server;
pub mod words;

pub use client::{ControlError, ask};
pub use path::SOCKET;
pub(super) use server::{Asked, Control};
