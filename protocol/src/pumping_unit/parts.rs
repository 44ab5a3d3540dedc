//! Geometry and masses of a double-horse-head unit.
//!
//! Frame: origin at the beam pivot, x towards the well, y up, z lateral; angles counter-clockwise
//! from +x. "Beam frame" is this frame turned with the beam; at beam angle 0 they coincide.
use serde::{Deserialize, Serialize};

/// Walking beam with both heads and everything rigid on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Beam {
    /// Moment of inertia of the whole assembly about the pivot [kg m2].
    pub inertia_kg_m2: f64,
    /// Static moment of the assembly's weight at beam angle 0 [N m]; positive lowers the front.
    pub gravity_moment_n_m: f64,
    /// The weight times the height of its centre of mass above the pivot at beam angle 0 [N m]; 0,
    /// on a line with the pivot, where none is stated. Positive where the beam is top-heavy.
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
    /// As case files write it.
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        to.write_str(match self {
            Self::Clockwise => "clockwise",
            Self::CounterClockwise => "counter_clockwise",
        })
    }
}

/// Prescribed crank.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crank {
    /// Shaft centre \[m\].
    pub center_x_m: f64,
    /// Shaft centre \[m\].
    pub center_y_m: f64,
    /// Distance from the shaft to the crank pin \[m\].
    pub radius_m: f64,
    /// Sense of rotation.
    pub sense: TurnSense,
    /// Angle by which the counterweight leads the crank pin \[deg\].
    pub counterweight_phase_deg: f64,
}

/// Connecting rods and crossbeam, one planar rigid body between crank pin and back rope.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rod {
    /// From the crank pin to the rope's revolute joint \[m\].
    pub length_m: f64,
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// From the crank pin to the centre of mass \[m\].
    pub center_of_mass_m: f64,
    /// Moment of inertia about its own centre of mass [kg m2].
    pub inertia_kg_m2: f64,
}

/// Carrier bar with clamp and load cell, guided vertically.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Suspension {
    /// Mass \[kg\].
    pub mass_kg: f64,
}

/// Both ropes: chains of equal cylinders.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ropes {
    /// Diameter of a cylinder \[m\].
    pub diameter_m: f64,
    /// Length of a cylinder \[m\].
    pub cylinder_length_m: f64,
    /// Density [kg/m3].
    pub density_kg_m3: f64,
    /// Length of cylinder that the genes' stiffness and damping belong to \[m\]; chains of other
    /// pitch are scaled so that the rope stays the same.
    pub reference_length_m: f64,
    /// Stiffness of the two end joints of a rope.
    pub ends: RopeEnds,
    /// Preload of every joint: its pull where nothing is stretched \[N\]; 0 where none is stated.
    #[serde(default)]
    pub preload_n: f64,
    /// Cylinders between crossbeam and back head.
    pub back_cylinders: usize,
    /// Cylinders between front head and suspension point.
    pub front_cylinders: usize,
}

/// Stiffness of the joints that hold a rope at its two ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum RopeEnds {
    /// Half a pitch each (twice the coefficients): the rope's compliance is exactly that of its
    /// length, whatever the pitch.
    HalfPitch,
    /// A whole pitch each, like every other joint.
    WholePitch,
}

/// IMPACT contact between rope and heads (paper, Eqs. 4-6).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// Exponent n of the penetration.
    pub exponent: f64,
    /// Penetration at which the damping reaches its full value, `d_max` \[m\].
    pub full_damping_penetration_m: f64,
}

/// Front head: a circular arc about the beam pivot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrontHead {
    /// Radius of the rope's centre line on the arc: the front arm \[m\].
    pub radius_m: f64,
    /// Where the rope is fixed, in the beam frame \[deg\].
    pub rope_anchor_deg: f64,
}

/// Back head: a circular arc about a centre of its own.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BackHead {
    /// Radius of the rope's centre line on the arc \[m\].
    pub radius_m: f64,
    /// Centre of the arc in the beam frame \[m\].
    pub center_x_m: f64,
    /// Centre of the arc in the beam frame \[m\].
    pub center_y_m: f64,
    /// Where the rope is fixed, as seen from the centre, in the beam frame \[deg\].
    pub rope_anchor_deg: f64,
}
