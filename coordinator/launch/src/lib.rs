//! Launching of workers on other nodes: a plan of plain data, and its execution.
//!
//! A launcher ([`ssh`], [`slurm`], [`k8s`], [`systemd`]) builds a [`LaunchPlan`]: literal commands with their
//! input, and files. `--dry-run` prints exactly the plan that a launch executes ([`execute`]). Scheduling
//! processes is left to the four systems named. A plan never contains a key: commands read key material from
//! its folder. The crate knows neither runs nor jobs nor simulations.
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
pub use plan::{LaunchPlan, PlanPart, PlanStep, StepInput};
pub use program::Program;
pub use worker_options::WorkerOptions;
