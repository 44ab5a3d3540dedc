//! Tables of a diagnosis: their content, not their layout.
mod answer;
mod ground;
mod instruments;
mod proof;
mod suspicion;
mod wander;

pub(super) use answer::{genes, sizes};
pub(super) use ground::{numerics, stages};
pub(super) use instruments::{absorbed, instruments};
pub(super) use proof::{gaps, paper};
pub(super) use suspicion::{generics, limits, look_alikes, suspects};
pub(super) use wander::{Wandering, wander};
