//! Zenoh bus: the coordinator embeds the router, workers are its clients.
//!
//! Scouting and gossip are off, so an end talks only to the address it was given. Leases of 3 s with six
//! keep-alives detect a dead peer within 2.8 s. Every publication blocks rather than drops, on a thread of
//! its own; receivers are callbacks into a bounded channel, because zenoh's default handler would block the
//! receiving thread of all workers. `tls/` is not offered: it corrupts memory in zenoh 1.10.2 (upstream issue
//! 2557).
mod access;
mod coordinator;
mod names;
mod sender;
mod session;
mod worker;

pub use coordinator::{CoordinatorOptions, ZenohCoordinator};
pub use worker::ZenohWorker;
