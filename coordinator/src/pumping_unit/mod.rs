//! What the coordinator knows of the pumping unit, the model of the kind `dhh`. Everything else there
//! asks for it by the kind that a case names.
pub mod report;
