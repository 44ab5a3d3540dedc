//! Workers on other nodes: a plan of plain data that brings them up, and carrying it out.
//!
//! A launcher ([`ssh`], [`slurm`], [`k8s`], [`systemd`]) writes a [`Plan`]: literal commands with what
//! each reads, and files. `--dry-run` prints the very plan that a launch carries out ([`execute`]).
//! Starting processes is the business of those four and of nobody here: nothing is scheduled. A plan
//! never holds a key: commands read key material from its folder. It does not know runs, jobs, nor
//! what a worker computes.
pub mod doctor;
pub mod execute;
mod host;
pub mod k8s;
pub mod keys;
mod plan;
mod program;
mod shell;
pub mod slurm;
pub mod ssh;
pub mod systemd;
mod worker_options;

pub use host::{Host, read_hosts};
pub use plan::{Input, Part, Plan, Step};
pub use program::Program;
pub use worker_options::WorkerOptions;
