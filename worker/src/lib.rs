//! Worker: takes jobs from the bus, simulates, returns outcomes.
//!
//! ```text
//! coordinator <-- link --> session (one per process) <-- pipes --> slot processes
//! ```
//!
//! A [`session`] owns the connection, the queue and the outbox; [`pool`] manages the slots; each slot
//! computes in a process of its own ([`slot`]), so that a job that crashes or never returns affects nothing
//! else. A worker keeps no files except, if asked to, one that states its [`status`]; it makes no scheduling
//! decisions. [`program`] wraps all of that in a
//! command line.
pub mod cli;
pub mod external;
pub mod handler;
pub mod outbox;
pub mod pool;
mod process_tree;
pub mod program;
pub mod pumping_unit;
pub mod session;
pub mod simulator;
pub mod slot;
pub mod status;
mod stream;
mod test_hook;

/// Kinds of model that the program `horsehead-worker` simulates.
pub const SIMULATORS: simulator::Simulators = &[&pumping_unit::PumpingUnits, &external::Externals];
