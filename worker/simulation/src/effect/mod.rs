//! Effects that the plain model omits, one file each, and the catalogue of them.
//!
//! An effect edits the description before the machine is built ([`Effect::describe`]) or hangs
//! pieces on the machine ([`Effect::install`]): forces, laws along a rope, a changed surface, a
//! crank ahead of uniform rotation, links of the chain from strain to reading. **At its absent
//! values an effect leaves every bit of a run unchanged**: it is not built at all. Effects act in
//! the order of the catalogue, whatever order they are asked for in.
//!
//! Equations are those of the machine's list of omitted effects; each file states its own. Nothing
//! here knows which effect a measurement calls for. How to add one: `README.md` of this crate.
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
pub use crate::model::hook::{
    Along, Axial, Dashpot, Effect, Force, Hollow, Hooks, LineForce, Memory, Reading, Sampled, Site,
    Strain,
};
pub use catalogue::catalogue;
pub use descriptor::{Descriptor, Parameter, Place, Role};
pub use selection::{Asked, Refused, Selection};
pub(crate) use selection::{Chosen, chosen};
pub use unit::Unit;
pub use value::Values;
