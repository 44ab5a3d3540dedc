//! Named effects, which have a physical cause: one file each, with two lines in this module (`mod` and an
//! entry of `IN_ORDER`).
mod amplifier_lag;
mod beam_balance;
mod beam_inertia;
mod card_smoothing;
mod card_time_shift;
mod counterweight_phase;
mod crank_angle_offset;
mod crank_speed_ripple;
mod fluid_pound;
mod front_head_radius;
mod front_rope_bending_loss;
mod gas_interference;
mod gauge_cross_talk;
mod gauge_drift;
mod gauge_gain;
mod head_damping;
mod head_profile_wear;
mod load_cell_gain;
mod load_cell_lag;
mod load_offset;
mod pin_clearance;
mod pivot_friction;
mod post_compliance;
mod rod_string_reaction;
mod rope_bending_loss;
mod rope_hysteresis;
mod rope_stretch;
mod rope_toe;
mod stuffing_box_friction;
mod twin_rope_inequality;
mod valve_leakage;

use super::descriptor::Descriptor;

/// Constructors of the named effects' descriptors in the order in which the effects act: load, machine,
/// crank, structure next to the gauges, gauges.
const IN_ORDER: &[fn() -> Descriptor] = &[
    card_time_shift::descriptor,
    load_cell_lag::descriptor,
    load_cell_gain::descriptor,
    load_offset::descriptor,
    card_smoothing::descriptor,
    valve_leakage::descriptor,
    gas_interference::descriptor,
    fluid_pound::descriptor,
    stuffing_box_friction::descriptor,
    rod_string_reaction::descriptor,
    front_head_radius::descriptor,
    front_rope_bending_loss::descriptor,
    beam_inertia::descriptor,
    beam_balance::descriptor,
    pivot_friction::descriptor,
    post_compliance::descriptor,
    head_profile_wear::descriptor,
    head_damping::descriptor,
    rope_stretch::descriptor,
    rope_toe::descriptor,
    rope_hysteresis::descriptor,
    rope_bending_loss::descriptor,
    crank_speed_ripple::descriptor,
    counterweight_phase::descriptor,
    crank_angle_offset::descriptor,
    pin_clearance::descriptor,
    twin_rope_inequality::descriptor,
    gauge_cross_talk::descriptor,
    gauge_drift::descriptor,
    gauge_gain::descriptor,
    amplifier_lag::descriptor,
];

/// Returns the descriptors of all named effects in their order of action.
pub(super) fn all() -> impl Iterator<Item = Descriptor> {
    IN_ORDER.iter().map(|descriptor| descriptor())
}
