//! Effects that the plain model omits, one file each, and their catalogue.
//!
//! An effect edits the description before the machine is built ([`Effect::describe`]) or attaches components
//! to the machine ([`Effect::install`]): forces, laws along a rope, a changed surface, a deviation of the
//! crank from uniform rotation, stages of the measuring chain from strain to reading. **At its absent values
//! an effect leaves every bit of a run unchanged**: it is not built at all. Effects act in the order of the
//! catalogue, independent of the order of the request.
//!
//! Each file states its equations, which are those of the project's list of omitted effects. Nothing in this
//! module depends on a particular measurement. How to add an effect: `README.md` of this crate.
mod catalogue;
mod descriptor;
mod generic;
mod named;
mod selection;
#[cfg(test)]
mod tests;
mod unit;
mod value;

pub use crate::model::cycle::Cycle;
pub use crate::model::extension::{
    Axial, Dashpot, Effect, Extensions, Force, Hollow, LineForce, LineForceValue, Memory,
    MemoryDerivatives, Reading, SampleState, Site, Strain,
};
pub use catalogue::catalogue;
pub use descriptor::{Descriptor, Parameter, Place, Role};
pub use selection::{EffectRequest, Selection, SelectionError};
pub(crate) use selection::{ResolvedEffect, chosen};
pub use unit::Unit;
pub use value::ParameterValues;
