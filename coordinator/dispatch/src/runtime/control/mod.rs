//! Control socket of an open run: lists workers and drains them.
//!
//! The socket lies in the run folder, accessible to the owner only, and speaks JSON lines: one request, one
//! answer ([`messages`]). It gives access to the workers of a run and to nothing else.
mod client;
pub mod messages;
mod path;
mod server;

pub use client::{ControlError, send_request};
pub use path::SOCKET;
pub(super) use server::{Control, PendingRequest};
