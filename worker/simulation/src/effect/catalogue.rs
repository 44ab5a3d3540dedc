//! Catalogue of all effects that can be added to the model.
use super::descriptor::Descriptor;
use super::{generic, named};
use std::sync::LazyLock;

static CATALOGUE: LazyLock<Vec<Descriptor>> =
    LazyLock::new(|| named::all().chain(generic::descriptors()).collect());

/// Returns the descriptors of all effects: first the named ones, then the generic forces.
pub fn catalogue() -> &'static [Descriptor] {
    &CATALOGUE
}
