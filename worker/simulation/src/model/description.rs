//! What a double-horse-head unit is made of, in SI units and radians; plain data.
//!
//! Frame W: origin at the beam pivot, x towards the well, y up, z lateral, angles
//! counter-clockwise from +x. The beam frame turns with the beam angle.
use crate::element::{bushing::Bushing, impact::Impact};

/// A unit with one working condition, without the rope coefficients that are searched.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Acceleration of gravity, along -y [m/s2].
    pub gravity: f64,
    /// Moment of inertia of beam, heads and all that is rigid on them, about the pivot [kg m2].
    pub beam_inertia: f64,
    /// Static moment of the assembly's weight at beam angle 0, positive lowers the front [N m].
    pub beam_gravity_moment: f64,
    /// The assembly's weight times the height of its centre of mass above the pivot at beam angle 0,
    /// positive where it tips over by itself [N m].
    pub beam_gravity_height: f64,
    /// Crank.
    pub crank: Crank,
    /// Rods and crossbeam.
    pub rod: Rod,
    /// Mass at the suspension point \[kg\].
    pub suspension_mass: f64,
    /// Rope geometry and mass.
    pub rope: Rope,
    /// Arc of the front head, about the pivot.
    pub front_arc: Arc,
    /// Arc of the back head.
    pub back_arc: Arc,
    /// Flexibility of the back head.
    pub head: Head,
    /// Two ropes on each head in place of one, if there are.
    pub twins: Option<Twins>,
    /// Load at the suspension point, positive downwards, equally spaced over one turn from bottom
    /// dead centre \[N\].
    pub card: Vec<f64>,
}

impl Description {
    /// Moment of the beam's weight about the pivot at a beam angle, given by its sine and cosine;
    /// positive lowers the front [N m]. The negative slope of [`Self::beam_potential`] is its force.
    pub(crate) fn beam_moment(&self, (sin, cos): (f64, f64)) -> f64 {
        self.beam_gravity_moment * cos - self.beam_gravity_height * sin
    }

    /// Potential of the beam's weight, 0 with its centre of mass level with the pivot \[J\].
    pub(crate) fn beam_potential(&self, (sin, cos): (f64, f64)) -> f64 {
        self.beam_gravity_moment * sin + self.beam_gravity_height * cos
    }
}

/// A crank whose motion is prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crank {
    /// Shaft centre \[m\].
    pub center: [f64; 2],
    /// Radius of the pin \[m\].
    pub radius: f64,
    /// +1 where the pin angle grows with time, -1 where it falls (clockwise).
    pub sense: f64,
    /// Full speed, positive [rad/s].
    pub speed: f64,
    /// Largest moment of the counterweight about the shaft [N m].
    pub counterweight_moment: f64,
    /// Angle of the counterweight before the pin's opposite, in the sense of rotation \[rad\].
    pub counterweight_phase: f64,
}

/// Connecting rods with crossbeam: one rigid body, pinned to the crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// Pin to rope joint \[m\].
    pub length: f64,
    /// Mass \[kg\].
    pub mass: f64,
    /// Pin to centre of mass \[m\].
    pub center_of_mass: f64,
    /// Moment of inertia about the centre of mass [kg m2].
    pub inertia: f64,
}

/// A rope of equal cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rope {
    /// Diameter of a cylinder \[m\].
    pub diameter: f64,
    /// Length of a cylinder \[m\].
    pub pitch: f64,
    /// Density [kg/m3].
    pub density: f64,
    /// Length that the rope coefficients belong to \[m\].
    pub reference_pitch: f64,
    /// Length of rope that an end joint stands for, in pitches: 0.5 or 1.
    pub end_pitches: f64,
    /// Cylinders between crossbeam and back head.
    pub back: usize,
    /// Cylinders between suspension point and front head.
    pub front: usize,
}

/// A circular arc fixed on the beam that a rope wraps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre in the beam frame \[m\].
    pub center: [f64; 2],
    /// Radius of the rope's centre line on it \[m\].
    pub radius: f64,
    /// Angle of the rope's fixed end, seen from the centre, in the beam frame \[rad\].
    pub anchor: f64,
    /// +1 where the rope runs towards its fixed end with growing angle, -1 where with falling.
    pub sense: f64,
}

/// Reduced flexible head: n modes over s stations of the rope arc.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Angular frequencies [rad/s]; n.
    pub frequencies: Vec<f64>,
    /// Damping ratio of every mode \[1\].
    pub damping_ratio: f64,
    /// How gauge stress follows from modes and forces.
    pub recovery: StressRecovery,
    /// First station \[rad\].
    pub start: f64,
    /// Spacing of the stations \[rad\].
    pub step: f64,
    /// Outward radial shape, mode by mode [kg^-1/2]; n x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential shape, towards growing angle; n x s.
    pub tangential: Vec<Vec<f64>>,
    /// Gauge stress per unit modal coordinate \[Pa\]; n x 4.
    pub gauge_stress: Vec<[f64; 4]>,
    /// Coupling with base acceleration in x, y and about the pivot; n x 3.
    pub participation: Vec<[f64; 3]>,
    /// Gauge stress under the head's own weight per unit gravity along -x and -y of the beam frame
    /// [Pa s2/m]; 2 x 4.
    pub weight_stress: [[f64; 4]; 2],
    /// Static gauge stress per unit angular acceleration about the pivot [Pa s2/rad].
    pub turning_stress: [f64; 4],
    /// First station of the influence lines \[rad\].
    pub influence_start: f64,
    /// Spacing of the influence lines \[rad\].
    pub influence_step: f64,
    /// Gauge stress per inward normal force [Pa/N], gauge by gauge; 4 x s'.
    pub normal_influence: Vec<Vec<f64>>,
    /// Gauge stress per tangential force towards growing angle [Pa/N]; 4 x s'.
    pub tangential_influence: Vec<Vec<f64>>,
}

/// Two ropes side by side on each head; what a [`Rope`] and a [`RopeLaw`] state is of both together.
#[derive(Clone, Debug, PartialEq)]
pub struct Twins {
    /// Distance of either rope from the machine's plane \[m\].
    pub offset: f64,
    /// By how much the rope at -z is longer than the one at +z, on the back and on the front head
    /// \[m\].
    pub longer: [f64; 2],
    /// What the back head does out of its plane.
    pub sway: Sway,
}

/// The antisymmetric side of a reduced head: a modes over the stations of [`Head`], at `z = +offset`.
/// Forces in its influence lines come in pairs.
#[derive(Clone, Debug, PartialEq)]
pub struct Sway {
    /// Angular frequencies [rad/s]; a.
    pub frequencies: Vec<f64>,
    /// Outward radial shape, mode by mode [kg^-1/2]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential shape, towards growing angle; a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Shape along z; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Gauge stress per unit modal coordinate \[Pa\]; a x 4.
    pub gauge_stress: Vec<[f64; 4]>,
    /// Gauge stress per newton inwards at +z and a newton outwards at -z [Pa/N]; 4 x s'.
    pub normal_influence: Vec<Vec<f64>>,
    /// Gauge stress per newton towards growing angle at +z and one back at -z; 4 x s'.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Gauge stress per newton along +z on either rope; 4 x s'.
    pub lateral_influence: Vec<Vec<f64>>,
}

/// A further mode of the head.
#[derive(Clone, Debug, PartialEq)]
pub struct AddedMode {
    /// Angular frequency [rad/s].
    pub frequency: f64,
    /// Outward radial shape [kg^-1/2]; s.
    pub radial: Vec<f64>,
    /// Tangential shape, towards growing angle; s.
    pub tangential: Vec<f64>,
    /// Coupling with base acceleration in x, y and about the pivot.
    pub participation: [f64; 3],
}

impl Head {
    /// Keeps the lowest modes.
    pub fn keep(&mut self, modes: usize) {
        self.frequencies.truncate(modes);
        self.radial.truncate(modes);
        self.tangential.truncate(modes);
        self.gauge_stress.truncate(modes);
        self.participation.truncate(modes);
    }

    /// Adds a mode behind the others; it is none of the head's own and strains no gauge.
    pub fn add(&mut self, mode: AddedMode) {
        self.frequencies.push(mode.frequency);
        self.radial.push(mode.radial);
        self.tangential.push(mode.tangential);
        self.gauge_stress.push([0.0; 4]);
        self.participation.push(mode.participation);
    }
}

/// How gauge stress follows from modal coordinates and forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StressRecovery {
    /// Influence lines for the statics, modes for what moves beyond.
    #[default]
    ModeAcceleration,
    /// Modes alone.
    ModeDisplacement,
}

/// The searched coefficients of rope and contact, for cylinders of the reference pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RopeLaw {
    /// Joint between two cylinders.
    pub bushing: Bushing,
    /// Contact of one cylinder with a head.
    pub contact: Impact,
}
