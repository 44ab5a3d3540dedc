//! Geometry and masses of a double-horse-head unit.
//!
//! Frame: origin at the beam pivot, x towards the well, y up, z lateral; angles counter-clockwise
//! from +x. "Beam frame" is this frame turned with the beam; at beam angle 0 they coincide.
use serde::{Deserialize, Serialize};

/// Walking beam with both heads and all parts rigidly attached to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Moment of inertia of the whole beam assembly about the pivot [kg m2].
    pub inertia_kg_m2: f64,
    /// Static moment of the beam assembly's weight at beam angle 0 [N m]; positive lowers the front.
    pub gravity_moment_n_m: f64,
    /// Weight of the beam assembly times the height of its centre of mass above the pivot at beam angle 0 [N
    /// m]; positive for a top-heavy beam. Default 0: centre of mass at the height of the pivot.
    #[serde(default)]
    pub gravity_height_moment_n_m: f64,
}

/// Sense in which the crank turns, seen with the well on the right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TurnSense {
    /// The crank-pin angle decreases with time.
    Clockwise,
    /// The crank-pin angle increases with time.
    CounterClockwise,
}

impl std::fmt::Display for TurnSense {
    /// Writes the name of the crank's sense of rotation as in case files.
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str(match self {
            Self::Clockwise => "clockwise",
            Self::CounterClockwise => "counter_clockwise",
        })
    }
}

/// Crank with prescribed motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crank {
    /// Centre of the crank shaft, x coordinate \[m\].
    pub center_x_m: f64,
    /// Centre of the crank shaft, y coordinate \[m\].
    pub center_y_m: f64,
    /// Distance from the shaft to the crank pin \[m\].
    pub radius_m: f64,
    /// Sense in which the crank turns.
    pub sense: TurnSense,
    /// Angle by which the counterweight leads the crank pin \[deg\].
    pub counterweight_phase_deg: f64,
    /// Rated torque of the reducer at the crank shaft [N m]; `None` if not stated.
    pub reducer_rating_n_m: Option<f64>,
    /// Weights that can be moved along the cranks; `None` if not stated. They act through the moment of each condition
    /// alone.
    pub counterweights: Option<Counterweights>,
}

/// Counterweights that can be moved along the cranks.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counterweights {
    /// Number of weights.
    pub count: u32,
    /// Mass of one weight \[kg\].
    pub mass_kg: f64,
    /// Moment of the cranks without weights about the shaft [N m].
    pub crank_moment_n_m: f64,
    /// Least distance of a weight's centre of mass from the shaft \[m\].
    pub nearest_m: f64,
    /// Largest distance of a weight's centre of mass from the shaft \[m\].
    pub farthest_m: f64,
}

/// Connecting rods and crossbeam, one planar rigid body between crank pin and back rope.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rod {
    /// Length of the connecting rod from the crank pin to the revolute joint at the rope \[m\].
    pub length_m: f64,
    /// Mass of connecting rods and crossbeam together \[kg\].
    pub mass_kg: f64,
    /// Distance from the crank pin to the centre of mass of rods and crossbeam \[m\].
    pub center_of_mass_m: f64,
    /// Moment of inertia of rods and crossbeam about their own centre of mass [kg m2].
    pub inertia_kg_m2: f64,
}

/// Carrier bar with clamp and load cell, guided vertically.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Suspension {
    /// Mass of carrier bar, clamp and load cell together \[kg\].
    pub mass_kg: f64,
}

/// Back and front rope: chains of equal cylinders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ropes {
    /// Diameter of a rope cylinder \[m\].
    pub diameter_m: f64,
    /// Length of a rope cylinder \[m\].
    pub cylinder_length_m: f64,
    /// Density of the rope cylinders [kg/m3].
    pub density_kg_m3: f64,
    /// Cylinder length for which the stiffness and damping of an individual hold \[m\]; for cylinders of
    /// another length the coefficients are scaled so that the rope stays the same.
    pub reference_length_m: f64,
    /// Stiffness of the joints at the two ends of each rope.
    pub ends: RopeEnds,
    /// Tension of every rope joint at zero elongation (preload) \[N\]; default 0.
    #[serde(default)]
    pub preload_n: f64,
    /// Number of back rope cylinders between crossbeam and back head.
    pub back_cylinders: usize,
    /// Number of front rope cylinders between front head and suspension point.
    pub front_cylinders: usize,
}

/// Stiffness of the joints that hold a rope at its two ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RopeEnds {
    /// Each end joint stands for half a cylinder (twice the coefficients), so that the rope's compliance is
    /// exactly that of its length for every cylinder length.
    HalfPitch,
    /// Each end joint stands for a whole cylinder, as every other joint does.
    WholePitch,
}

/// IMPACT contact between rope and heads (paper, Eqs. 4-6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Exponent n of the penetration in the law of the contact force between rope and heads.
    pub exponent: f64,
    /// Penetration of the rope into a head at which the contact damping reaches its full value, `d_max`
    /// \[m\].
    pub full_damping_penetration_m: f64,
}

/// Front head: a circular arc about the beam pivot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrontHead {
    /// Radius of the rope's centre line on the arc: the front arm \[m\].
    pub radius_m: f64,
    /// Angle at which the rope is fixed to the front head, in the beam frame \[deg\].
    pub rope_anchor_deg: f64,
}

/// Back head: a circular arc about a centre of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BackHead {
    /// Radius of the rope's centre line on the arc \[m\].
    pub radius_m: f64,
    /// Centre of the arc in the beam frame, x \[m\].
    pub center_x_m: f64,
    /// Centre of the arc in the beam frame, y \[m\].
    pub center_y_m: f64,
    /// Angle at which the rope is fixed to the back head, about the arc's centre, in the beam frame \[deg\].
    pub rope_anchor_deg: f64,
}
