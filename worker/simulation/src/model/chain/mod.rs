//! Chain of equal cylinders: its joints, weight, contact with one arc, and their tangent.
//!
//! These are the kernels of every rope, in a machine or alone on a test rig. A chain knows the markers that
//! hold its ends, not the bodies to which they belong; the effect of an end joint on the holding body is
//! computed by that body. Joint 0 is before the first cylinder, joint n behind the last; J is the marker
//! nearer to the chain's base, I the one nearer to its head.
mod axial;
mod contact;
mod contact_group;
pub(crate) mod contact_point;
mod contact_tangent;
mod energy;
mod forces;
mod inertia;
mod link;
pub(crate) mod parts;
mod plane;
pub(crate) mod points;
pub(crate) mod state;
pub(crate) mod tangent;
pub(crate) mod unit_loads;

pub use parts::{Chain, EndJoint, Joints};
pub use state::ChainState;
