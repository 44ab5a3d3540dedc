//! Tables of results, one file per subject: what a table shows, not how it is set.
mod compare;
mod gap;
mod head;
mod single;
mod worker;

pub use super::document::{Table, set_table as text};
pub use compare::{table_3, table_4};
pub(super) use gap::gap;
pub use head::{head_modes, head_pair, head_statics};
pub(super) use single::genes;
pub use single::{balance, simulation};
pub use worker::slot_time;
pub(super) use worker::workers;
pub use worker::{hosts, jobs};
