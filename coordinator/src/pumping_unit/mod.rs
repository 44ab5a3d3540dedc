//! What the coordinator knows of the pumping unit, the model of the kind `dhh`. Everything else there
//! asks for it by the kind that a case names.
pub(crate) mod command;
mod digest;
pub(crate) mod kind;
mod output;
mod reduce_head;

pub use digest::simulation_digest;
pub use reduce_head::reduce_head;
