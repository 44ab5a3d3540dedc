//! Job dispatch to workers that join and leave; independent of the physics.
//!
//! The sans-I/O [`scheduler`] leases jobs, and the [`runtime`] is the only asynchronous glue between scheduler,
//! [`journal`], bus and the worker processes of this machine. [`bench`](mod@bench) measures the dispatch
//! of empty jobs. The feature `simulated` adds a cluster on a simulated clock, for tests and projections.
//! Jobs are opaque here: no code interprets the content of a case, and the caller divides jobs
//! ([`Divide`](runtime::Divide)).
pub mod bench;
pub mod runtime;
pub mod scheduler;
#[cfg(any(test, feature = "simulated"))]
pub mod simulated;
