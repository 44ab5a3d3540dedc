//! Job dispatch to workers that join and leave, with a journal that keeps every result; independent of the
//! physics.
//!
//! The sans-I/O [`scheduler`] leases jobs, the [`journal`] records results, and the [`runtime`] is the only
//! asynchronous glue between scheduler, journal, bus and the worker processes of this machine. [`account`]
//! sums how slots spent their time. [`simulated`] runs the scheduler on a simulated clock. Jobs are opaque
//! here: no code interprets the content of a case.
pub mod account;
pub mod journal;
pub mod runtime;
pub mod scheduler;
pub mod simulated;
