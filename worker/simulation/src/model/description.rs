//! Parameters of a double-horse-head unit as plain data, in SI units and radians.
//!
//! Frame W: origin at the beam pivot, x towards the well, y up, z lateral, angles counter-clockwise from +x.
//! The beam frame rotates with the beam angle.
use crate::element::{bushing::Bushing, impact::Impact};

/// Parameters of a pumping unit under one working condition, except the rope coefficients that the search
/// varies.
#[derive(Clone, Debug, PartialEq)]
pub struct Description {
    /// Acceleration of gravity, along -y [m/s2].
    pub gravity: f64,
    /// Moment of inertia about the pivot of the beam, the heads and all parts fixed to them [kg m2].
    pub beam_inertia: f64,
    /// Static moment of the weight of beam and heads at beam angle 0; positive lowers the front [N m].
    pub beam_gravity_moment: f64,
    /// Weight of beam and heads times the height of their centre of mass above the pivot at beam angle 0;
    /// positive where the equilibrium is unstable [N m].
    pub beam_gravity_height: f64,
    /// Parameters of the crank.
    pub crank: Crank,
    /// Parameters of connecting rods and crossbeam.
    pub rod: Rod,
    /// Mass at the suspension point \[kg\].
    pub suspension_mass: f64,
    /// Geometry and density of the ropes.
    pub rope: Rope,
    /// Arc of the front head, about the pivot.
    pub front_arc: Arc,
    /// Arc of the back head.
    pub back_arc: Arc,
    /// Reduced-order model of the flexible back head.
    pub head: Head,
    /// Parameters of parallel twin ropes; `None` for a single rope on each head.
    pub twins: Option<Twins>,
    /// Load card: load at the suspension point, positive downwards, equally spaced over one turn from bottom
    /// dead centre \[N\].
    pub card: Vec<f64>,
}

impl Description {
    /// Returns the moment of the beam's weight about the pivot [N m], positive where it lowers the front,
    /// from the sine and cosine of the beam angle. It is the derivative of [`Self::beam_potential`] with
    /// respect to the beam angle, so that the generalised force is its negative.
    pub(crate) fn beam_moment(&self, (sin, cos): (f64, f64)) -> f64 {
        self.beam_gravity_moment * cos - self.beam_gravity_height * sin
    }

    /// Returns the potential energy of the beam's weight \[J\] from the sine and cosine of the beam angle; 0
    /// where the centre of mass is level with the pivot.
    pub(crate) fn beam_potential(&self, (sin, cos): (f64, f64)) -> f64 {
        self.beam_gravity_moment * sin + self.beam_gravity_height * cos
    }
}

/// Geometry, speed and counterweight of the crank, whose motion is prescribed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crank {
    /// Position of the crankshaft's centre \[m\].
    pub center: [f64; 2],
    /// Distance of the crank pin from the shaft centre \[m\].
    pub radius: f64,
    /// Sense of rotation: +1 where the pin angle increases with time, -1 where it decreases (clockwise).
    pub sense: f64,
    /// Nominal angular speed, positive [rad/s].
    pub speed: f64,
    /// Largest moment of the counterweight about the shaft [N m].
    pub counterweight_moment: f64,
    /// Lead angle of the counterweight, in the sense of rotation, ahead of the direction opposite to the pin
    /// \[rad\].
    pub counterweight_phase: f64,
}

/// Connecting rods and crossbeam as one rigid body, pinned to the crank.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rod {
    /// Distance from the crank pin to the rope joint \[m\].
    pub length: f64,
    /// Mass of connecting rods and crossbeam \[kg\].
    pub mass: f64,
    /// Distance from the crank pin to the centre of mass of rods and crossbeam \[m\].
    pub center_of_mass: f64,
    /// Moment of inertia of rods and crossbeam about their centre of mass [kg m2].
    pub inertia: f64,
}

/// Geometry and density of a rope modelled as a chain of equal cylinders.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rope {
    /// Diameter of the rope's cylinders \[m\].
    pub diameter: f64,
    /// Length of one cylinder of the rope \[m\].
    pub pitch: f64,
    /// Density of the rope's cylinders [kg/m3].
    pub density: f64,
    /// Cylinder length for which the coefficients of joints and contact are stated \[m\].
    pub reference_pitch: f64,
    /// Length of rope represented by the joint at either end of a rope, in cylinder lengths: 0.5 or 1.
    pub end_pitches: f64,
    /// Number of cylinders between crossbeam and back head.
    pub back: usize,
    /// Number of cylinders between suspension point and front head.
    pub front: usize,
}

/// Circular arc fixed to the beam, around which a rope wraps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arc {
    /// Centre of the arc in the beam frame \[m\].
    pub center: [f64; 2],
    /// Radius of the centre line of the rope lying on the arc \[m\].
    pub radius: f64,
    /// Angle of the rope's fixed end, seen from the centre, in the beam frame \[rad\].
    pub anchor: f64,
    /// Direction of the rope towards its fixed end: +1 for increasing angle, -1 for decreasing angle.
    pub sense: f64,
}

/// Reduced-order model of the flexible head: n modes sampled at s stations along the rope arc.
#[derive(Clone, Debug, PartialEq)]
pub struct Head {
    /// Angular frequencies of the n modes [rad/s].
    pub frequencies: Vec<f64>,
    /// Damping ratio common to all modes \[1\].
    pub damping_ratio: f64,
    /// Method by which gauge stress is recovered from modal coordinates and forces.
    pub recovery: StressRecovery,
    /// Arc angle of the first station at which mode shapes are given \[rad\].
    pub start: f64,
    /// Angular spacing of the stations at which mode shapes are given \[rad\].
    pub step: f64,
    /// Radial mode shapes, positive outwards [kg^-1/2]; n x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential mode shapes, positive towards increasing angle [kg^-1/2]; n x s.
    pub tangential: Vec<Vec<f64>>,
    /// Gauge stress per unit modal coordinate \[Pa\]; n x 4.
    pub gauge_stress: Vec<[f64; 4]>,
    /// Modal participation factors for base acceleration in x, in y and about the pivot; n x 3.
    pub participation: Vec<[f64; 3]>,
    /// Gauge stress caused by the head's own weight per unit of gravity along -x and -y of the beam frame [Pa
    /// s2/m]; 2 x 4.
    pub weight_stress: [[f64; 4]; 2],
    /// Static gauge stress per unit angular acceleration about the pivot [Pa s2/rad].
    pub turning_stress: [f64; 4],
    /// Arc angle of the first station of the influence lines \[rad\].
    pub influence_start: f64,
    /// Angular spacing of the stations of the influence lines \[rad\].
    pub influence_step: f64,
    /// Ends of the intervals of the arc over which the rope's normal force is recorded, ascending from the rope's
    /// fixed end \[rad\]; what lies beyond belongs to the first or last interval.
    pub load_breaks: Vec<f64>,
    /// Gauge stress per unit of inward normal force at each of s' stations of the influence lines [Pa/N]; 4 x
    /// s'.
    pub normal_influence: Vec<Vec<f64>>,
    /// Gauge stress per unit of tangential force, positive towards increasing angle, at each of s' stations
    /// of the influence lines [Pa/N]; 4 x s'.
    pub tangential_influence: Vec<Vec<f64>>,
}

/// Parameters of two parallel ropes on each head. Coefficients in [`Rope`] and [`RopeLaw`] are those of both
/// ropes together.
#[derive(Clone, Debug, PartialEq)]
pub struct Twins {
    /// Distance of each rope from the machine's plane \[m\].
    pub offset: f64,
    /// Excess length of the rope at -z over the rope at +z, on the back head and on the front head \[m\].
    pub longer: [f64; 2],
    /// Out-of-plane (antisymmetric) flexibility of the back head, excited by unequal tension of the twin
    /// ropes.
    pub sway: AntisymmetricHead,
}

/// Antisymmetric part of a reduced head model: `a` modes, sampled at the stations of [`Head`] on the rope at
/// `z = +offset`. Each influence line belongs to a pair of forces, one on either twin rope.
#[derive(Clone, Debug, PartialEq)]
pub struct AntisymmetricHead {
    /// Angular frequencies of the `a` antisymmetric modes [rad/s].
    pub frequencies: Vec<f64>,
    /// Radial mode shapes, positive outwards [kg^-1/2]; a x s.
    pub radial: Vec<Vec<f64>>,
    /// Tangential mode shapes, positive towards increasing angle [kg^-1/2]; a x s.
    pub tangential: Vec<Vec<f64>>,
    /// Mode shapes along z [kg^-1/2]; a x s.
    pub lateral: Vec<Vec<f64>>,
    /// Gauge stress per unit modal coordinate \[Pa\]; a x 4.
    pub gauge_stress: Vec<[f64; 4]>,
    /// Gauge stress per newton acting inwards at `z = +offset` together with a newton acting outwards at `z =
    /// -offset` [Pa/N]; 4 x s'.
    pub normal_influence: Vec<Vec<f64>>,
    /// Gauge stress per newton towards increasing angle at `z = +offset` together with a newton in the
    /// opposite direction at `z = -offset` [Pa/N]; 4 x s'.
    pub tangential_influence: Vec<Vec<f64>>,
    /// Gauge stress per newton along +z on each rope [Pa/N]; 4 x s'.
    pub lateral_influence: Vec<Vec<f64>>,
}

/// Additional mode that is appended to the modes of a head.
#[derive(Clone, Debug, PartialEq)]
pub struct AddedMode {
    /// Angular frequency of the added mode [rad/s].
    pub frequency: f64,
    /// Radial shape of the added mode at the head's s stations, positive outwards [kg^-1/2].
    pub radial: Vec<f64>,
    /// Tangential shape of the added mode at the head's s stations, positive towards increasing angle
    /// [kg^-1/2].
    pub tangential: Vec<f64>,
    /// Modal participation factors of the added mode for base acceleration in x, in y and about the pivot.
    pub participation: [f64; 3],
}

impl Head {
    /// Truncates the head's modal basis to its first `modes` modes, those of lowest frequency.
    pub fn keep(&mut self, modes: usize) {
        self.frequencies.truncate(modes);
        self.radial.truncate(modes);
        self.tangential.truncate(modes);
        self.gauge_stress.truncate(modes);
        self.participation.truncate(modes);
    }

    /// Appends a mode to the head's modes; its gauge stress is zero.
    pub fn add(&mut self, mode: AddedMode) {
        self.frequencies.push(mode.frequency);
        self.radial.push(mode.radial);
        self.tangential.push(mode.tangential);
        self.gauge_stress.push([0.0; 4]);
        self.participation.push(mode.participation);
    }
}

/// Method of recovering gauge stress from modal coordinates and forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StressRecovery {
    /// Mode-acceleration method: influence lines give the static part, modes the dynamic part.
    #[default]
    ModeAcceleration,
    /// Mode-displacement method: stress from the modal coordinates alone.
    ModeDisplacement,
}

/// Coefficients of rope and contact that the search varies, stated for cylinders of the reference pitch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RopeLaw {
    /// Coefficients of the joint between two cylinders.
    pub bushing: Bushing,
    /// Coefficients of the contact between a cylinder of the rope and a head.
    pub contact: Impact,
}
