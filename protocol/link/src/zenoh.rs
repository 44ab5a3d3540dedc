//! The bus: the coordinator is the router, workers are its clients.
//!
//! Scouting and gossip are off, so an end talks to the one address it was given. Leases of 3 s
//! with six keep-alives show a dead peer in 2.8 s at most; every publication blocks rather than
//! drops, on a thread of its own; receivers are callbacks into a bounded channel, because the
//! default handler would hold up the receiving thread of all workers. `tls/` is not offered: it
//! corrupts memory in zenoh 1.10.2 (upstream issue 2557).
mod access;
mod coordinator;
mod names;
mod sender;
mod session;
mod worker;

pub use coordinator::{CoordinatorOptions, ZenohCoordinator};
pub use worker::ZenohWorker;
