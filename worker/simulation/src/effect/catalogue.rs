//! Every effect there is.
use super::descriptor::Descriptor;
use super::{generic, named};
use std::sync::LazyLock;

static CATALOGUE: LazyLock<Vec<Descriptor>> =
    LazyLock::new(|| named::all().chain(generic::descriptors()).collect());

/// Every effect there is: the named ones, then the generic forces.
pub fn catalogue() -> &'static [Descriptor] {
    &CATALOGUE
}
