//! Parts of the coordinator that are specific to the pumping unit, model kind `dhh`; the rest of the
//! coordinator reaches them through the kind named by the case.
pub(crate) mod command;
mod digest;
pub(crate) mod kind;
mod output;
mod reduce_head;

pub use digest::simulation_digest;
pub use reduce_head::reduce_head;
