//! Effects that the plain model omits, one file each, and the catalogue of them.
//!
//! An effect edits the description before the machine is built ([`Effect::describe`]) or hangs
//! pieces on the machine ([`Effect::install`]): forces, laws along a rope, a changed surface, a
//! crank ahead of uniform rotation, links of the chain from strain to reading. **At its absent
//! values an effect leaves every bit of a run unchanged**: it is not built at all. Effects act in
//! the order of the catalogue, whatever order they are asked for in.
//!
//! Equations are those of the machine's list of omitted effects; each file states its own. Nothing
//! here knows which effect a measurement calls for.
mod amplifier_lag;
mod beam_inertia;
mod card_smoothing;
mod card_time_shift;
mod counterweight_phase;
mod crank_angle_offset;
mod crank_speed_ripple;
mod cycle;
mod descriptor;
mod fluid_pound;
mod front_head_radius;
mod front_rope_bending_loss;
mod gas_interference;
mod gauge_cross_talk;
mod gauge_drift;
mod gauge_gain;
mod head_damping;
mod head_profile_wear;
mod hooks;
mod line;
mod load_cell_gain;
mod load_cell_lag;
mod load_offset;
mod pin_clearance;
mod pivot_friction;
mod post_compliance;
mod probe;
mod profile;
mod rod_string_reaction;
mod rope_bending_loss;
mod rope_hysteresis;
mod rope_stretch;
mod rope_toe;
mod selection;
mod stuffing_box_friction;
mod twin_rope_inequality;
mod valve_leakage;

#[cfg(test)]
mod force_tests;
#[cfg(test)]
mod tests;

pub use cycle::Cycle;
pub use descriptor::{Descriptor, Parameter, Place, Role, Unit};
pub use hooks::{Axial, AxialLaws, Force, Hooks, Memory, Reading, Sampled, Strain};
pub use line::{Along, Dashpot, LineForce};
pub use profile::{Hollow, Profile};
pub use selection::{Asked, Refused, Selection};

use crate::model::Machine;
use crate::model::description::Description;
use std::fmt::Debug;
use std::sync::LazyLock;

/// An effect with its values.
pub trait Effect: Debug + Send + Sync {
    /// Edits the machine before it is built: geometry, inertia, samples of the card; `modes` is the
    /// number of head modes that are kept.
    fn describe(&self, _description: &mut Description, _modes: &mut usize) {}

    /// Hangs pieces on the built machine; `cycle` is one turn of its ideal mechanism.
    fn install(&self, _machine: &Machine, _cycle: &Cycle, _hooks: &mut Hooks) {}
}

/// Named effects in the order in which they act: the load, the machine, the crank, the structure
/// beside the gauges, the gauges.
const NAMED: [Descriptor; 30] = [
    card_time_shift::DESCRIPTOR,
    load_cell_lag::DESCRIPTOR,
    load_cell_gain::DESCRIPTOR,
    load_offset::DESCRIPTOR,
    card_smoothing::DESCRIPTOR,
    valve_leakage::DESCRIPTOR,
    gas_interference::DESCRIPTOR,
    fluid_pound::DESCRIPTOR,
    stuffing_box_friction::DESCRIPTOR,
    rod_string_reaction::DESCRIPTOR,
    front_head_radius::DESCRIPTOR,
    front_rope_bending_loss::DESCRIPTOR,
    beam_inertia::DESCRIPTOR,
    pivot_friction::DESCRIPTOR,
    post_compliance::DESCRIPTOR,
    head_profile_wear::DESCRIPTOR,
    head_damping::DESCRIPTOR,
    rope_stretch::DESCRIPTOR,
    rope_toe::DESCRIPTOR,
    rope_hysteresis::DESCRIPTOR,
    rope_bending_loss::DESCRIPTOR,
    crank_speed_ripple::DESCRIPTOR,
    counterweight_phase::DESCRIPTOR,
    crank_angle_offset::DESCRIPTOR,
    pin_clearance::DESCRIPTOR,
    twin_rope_inequality::DESCRIPTOR,
    gauge_cross_talk::DESCRIPTOR,
    gauge_drift::DESCRIPTOR,
    gauge_gain::DESCRIPTOR,
    amplifier_lag::DESCRIPTOR,
];

static CATALOGUE: LazyLock<Vec<Descriptor>> =
    LazyLock::new(|| NAMED.into_iter().chain(probe::descriptors()).collect());

/// Every effect there is: the named ones, then the generic forces.
pub fn catalogue() -> &'static [Descriptor] {
    &CATALOGUE
}
