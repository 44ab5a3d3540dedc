//! Workers on other nodes: a plan of plain data that brings them up, and carrying it out.
//!
//! A launcher ([`ssh`], [`slurm`], [`k8s`], [`systemd`]) writes a [`Plan`]: literal commands with what
//! each reads, and files. `--dry-run` prints the very plan that a launch carries out ([`launch`]).
//! Starting processes is the business of those four and of nobody here: nothing is scheduled. A plan
//! never holds a key: commands read key material from its folder. It does not know runs, jobs, nor
//! what a worker computes.
mod error;
mod host;
pub mod k8s;
pub mod keys;
pub mod launch;
mod order;
mod plan;
mod program;
pub mod slurm;
pub mod ssh;
pub mod systemd;

mod words;

pub use error::NodeError;
pub use host::{Host, read_hosts};
pub use order::Order;
pub use plan::{Input, Part, Plan, Step};
pub use program::Program;
