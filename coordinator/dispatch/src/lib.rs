//! Gives jobs to workers that come and go, and keeps every result: a run without its physics.
//!
//! The sans-I/O [`scheduler`] leases jobs, the [`journal`] records what came back, the [`runtime`] is the only
//! asynchronous glue between them, the bus and the worker processes of this machine. [`account`] adds up how slots spent their time. [`simulated`] runs the scheduler
//! on a clock of its own. Jobs are opaque here: nothing knows what a case holds.
pub mod account;
pub mod journal;
pub mod runtime;
pub mod scheduler;
pub mod simulated;
