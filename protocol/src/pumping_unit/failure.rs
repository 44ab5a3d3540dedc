//! Causes that end a simulation of a pumping unit early.
use crate::job::Identifier;

/// Cause: a rope joint stretched beyond its limit.
pub const OVERSTRETCHED_ROPE: Identifier = Identifier::new("overstretched_rope");
/// Cause: the rope penetrated the surface of a head.
pub const ROPE_THROUGH_HEAD: Identifier = Identifier::new("rope_through_head");
/// Cause: the beam left its working range.
pub const BEAM_OVERTRAVEL: Identifier = Identifier::new("beam_overtravel");
/// Cause: the load stayed below its lowest design position.
pub const LOAD_NOT_LIFTED: Identifier = Identifier::new("load_not_lifted");
/// Cause: a rope cylinder turned over.
pub const TUMBLED_CYLINDER: Identifier = Identifier::new("tumbled_cylinder");
/// Cause: the time step fell below its lower limit.
pub const STEP_UNDERFLOW: Identifier = Identifier::new("step_underflow");
/// Cause: the budget of Newton iterations was used up.
pub const BUDGET: Identifier = Identifier::new("budget");

/// All causes of a failed simulation, each with a description that can be part of a sentence.
pub const ALL: [(Identifier, &str); 7] = [
    (
        OVERSTRETCHED_ROPE,
        "a rope joint was stretched beyond its limit",
    ),
    (
        ROPE_THROUGH_HEAD,
        "the rope sank through the surface of a head",
    ),
    (BEAM_OVERTRAVEL, "the beam left its working range"),
    (LOAD_NOT_LIFTED, "the load was not lifted"),
    (TUMBLED_CYLINDER, "a rope cylinder turned over"),
    (STEP_UNDERFLOW, "the step size fell below its limit"),
    (
        BUDGET,
        "the iteration budget was used up; `iteration_budget` in [run] of case.toml raises it",
    ),
];
