//! Tables of a diagnosis: their content, not their layout.
mod answer;
mod candidates;
mod instruments;
mod parameter_drift;
mod reliability;
mod validation;

pub(super) use answer::{genes, sizes};
pub(super) use candidates::{candidate_effects, generics, limits, look_alikes};
pub(super) use instruments::{absorbed, instruments};
pub(super) use parameter_drift::{VariationUnderModel, wander};
pub(super) use reliability::{numerics, stages};
pub(super) use validation::{gaps, paper};
