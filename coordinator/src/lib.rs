//! Decides what to evaluate and remembers everything.
//!
//! Data flows one way: a case folder is read and checked ([`case`]), a search strategy proposes
//! individuals, the sans-I/O [`core`] leases them to workers, the [`journal`] records what came
//! back, the [`account`] of slot time and the [`report`] show it, the [`store`] makes tables of it for queries. [`study`] is the loop from the first proposal to the
//! comparison of the result, [`cli`] the commands around it, [`runtime`] the only asynchronous
//! glue, the crate `launch` what starts workers elsewhere. Nothing here links the dynamics.
pub mod account;
pub mod case;
pub mod cli;
pub mod core;
mod digest;
mod draft;
mod external;
pub mod journal;
mod kind;
mod line;
pub mod orthogonal;
pub mod pumping_unit;
pub mod quantile;
pub mod report;
pub mod runtime;
pub mod scaling;
pub mod simulated;
pub mod store;
pub mod study;
