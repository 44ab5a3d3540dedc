//! Stand-in machine that the tool simulates: its announced effect library and a laboratory that runs it.
mod amounts;
mod at_once;
mod drive;
mod fineness;
mod lags;
pub(crate) mod library;
mod stand_in;
mod turn;

pub(crate) use at_once::{ImmediateLaboratory, Roughness, ripple};
pub(crate) use fineness::finer;
pub(crate) use stand_in::Machine;
