//! State machine that leases jobs to workers; does no network or file access and reads no clock.
//!
//! ```text
//! Submit -> queued -> leased -> result accepted -> stored -> acknowledged
//!             ^         |  (lost, overdue, crashed: offered again, within limits)
//!             +---------+
//! ```
//!
//! Jobs that the run will probably request can be computed ahead by slots that would be idle.
//!
//! Jobs are pure functions, so the first result of a job is accepted, whichever worker delivers it and
//! however late; later results are acknowledged and dropped. A result is delivered as soon as it is accepted
//! but acknowledged only once it is stored, so a worker forgets nothing that a crash of this process could
//! lose.
//!
//! Each file depends only on those listed before it: the state (`state` over `part`, `member`, `slot_time`,
//! `policy`, `times`, `failures`); `lease`; `result` and `roster`; `drain`, `admission_rules`, `admission` and
//! `reconcile`; `membership`; `assign`, `anticipated` and `stragglers`; and at the top `inbox`, which receives all inputs.
mod admission;
mod admission_rules;
mod anticipated;
mod assign;
mod completed;
mod drain;
mod failures;
mod inbox;
mod input;
#[cfg(test)]
mod invariants;
mod job_set;
mod lease;
mod member;
mod membership;
mod notice;
mod policy;
mod reconcile;
mod result;
mod roster;
mod slot_time;
mod snapshot;
mod state;
mod stragglers;
#[cfg(test)]
mod tests;
mod times;
mod unclaimed_results;
mod worker_report;

pub use completed::Completed;
pub use input::{Command, Drain, Input};
pub use job_set::JobSet;
pub use notice::{Notice, StopReason};
pub use policy::{PAUSE_LIMIT, Policy};
pub use snapshot::Snapshot;
pub use state::{Core, CoreOptions};
pub use worker_report::{HeldJob, WorkerPhase, WorkerReport};
