//! Coordinator: decides what to evaluate and records every result.
//!
//! Data flows one way: a case folder is read and checked (crate `case`), a search strategy proposes
//! individuals, `dispatch` has them computed and records the results, `report` displays these, `store`
//! exports them as tables for queries. `study` contains the loop from the first proposal to the comparison of
//! the result, `run` the folders and sessions of runs, `dashboard` their pages in a browser, [`cli`] the commands, and
//! `launch` the start of workers on other hosts. No code here links the dynamics.
pub mod cli;
#[cfg(test)]
#[path = "../store/src/read_back.rs"]
mod read_back;
#[cfg(test)]
#[path = "../study/src/test_evaluator.rs"]
mod test_evaluator;
