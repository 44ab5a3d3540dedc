//! Parts of the coordinator that are specific to the pumping unit, model kind `dhh`; other parts call them
//! only through the trait for model kinds.
pub(crate) mod command;
mod digest;
pub(crate) mod kind;
mod output;
pub(crate) mod record;
mod reduce_head;

pub use digest::simulation_digest;
pub use reduce_head::reduce_head;
