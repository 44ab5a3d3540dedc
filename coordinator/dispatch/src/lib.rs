//! Job dispatch to workers that join and leave; independent of the physics.
//!
//! The sans-I/O [`scheduler`] leases jobs, and the [`runtime`] is the only asynchronous glue between scheduler,
//! [`journal`], bus and the worker processes of this machine. [`simulated`] runs the scheduler on a simulated clock.
//! Jobs are opaque here: no code interprets the content of a case, and the caller divides jobs
//! ([`Divide`](runtime::Divide)).
pub mod runtime;
pub mod scheduler;
pub mod simulated;
