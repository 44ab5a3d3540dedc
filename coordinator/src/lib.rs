//! Decides what to evaluate and remembers everything.
//!
//! Data flows one way: a case folder is read and checked (the crate `case`), a search strategy proposes individuals,
//! `dispatch` has them computed and records what came back, `report` shows it, `store` makes tables of it for queries.
//! `study` is the loop from the first proposal to the comparison of the result, [`cli`] the commands around it,
//! `launch` what starts workers elsewhere. Nothing here links the dynamics.
pub mod cli;
mod digest;
mod kind;
#[cfg(test)]
#[path = "../study/src/oracle.rs"]
mod oracle;
pub mod pumping_unit;
#[cfg(test)]
#[path = "../store/src/read_back.rs"]
mod read_back;
