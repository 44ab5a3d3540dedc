//! Pumping unit with double horse heads: the model-specific content of its cases, jobs and answers.
//!
//! Plain data of one model, with the unit in every name. Only three folders know this data: this one, the
//! folder of the worker that simulates the machine, and the folder of the coordinator that reads and draws
//! it. This module knows nothing of files or of dynamics.
mod card;
mod coefficient;
mod discretisation;
mod drawing;
mod effect_unit;
pub mod failure;
mod head;
mod head_loads;
mod machine;
mod parts;
mod reduce_head;
mod run;
mod sensor;
mod twin;

pub use card::{LoadCard, Smoothing};
pub use coefficient::Coefficient;
pub use discretisation::Discretisation;
pub use drawing::{Energy, MachineSnapshot, Simulation};
pub use effect_unit::EFFECT_UNITS;
pub use head::{Influence, ModalHead, StressRecovery};
pub use head_loads::{HeadLoads, HeadSurface};
pub use machine::{Machine, PumpingUnit, WorkingCondition};
pub use parts::{
    BackHead, Beam, Contact, Counterweights, Crank, FrontHead, Rod, RopeEnds, Ropes, Suspension,
    TurnSense,
};
pub use reduce_head::{
    ElementKind, HeadFields, HeadGauge, HeadMesh, HeadMode, ModeFamily, OmittedMode, REDUCE_HEAD,
    ReduceHeadSpec, ReducedHead, RopePair, RopeWrap, SurfaceRequest,
};
pub use run::{Integrator, RunSettings};
pub use sensor::Sensor;
pub use twin::{TwinHead, TwinRopes};
