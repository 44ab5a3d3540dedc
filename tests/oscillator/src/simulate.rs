//! One simulation of the oscillator test rig: motion of the mass and readings of the sensors.
//!
//! Channels have their names and units of the case here; encoding of cases and jobs is handled elsewhere.
use crate::{
    effect::Effects,
    motion::{Drive, Oscillator, State},
    settings::{Excitation, RigSettings},
    sum::Sum,
};
use std::f64::consts::TAU;

/// Values of the oscillator's unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Values {
    /// Mass of the carriage \[kg\].
    pub mass_kg: f64,
    /// Mass of the shaker's armature, which moves with the carriage \[kg\].
    pub armature_kg: f64,
    /// Stiffness of the spring on the left [N/mm].
    pub left_n_per_mm: f64,
    /// Stiffness of the spring on the right [N/mm].
    pub right_n_per_mm: f64,
    /// Viscous damping of the mass [N s/m].
    pub damping_n_s_per_m: f64,
    /// Phase lead of the shaker's force \[deg\].
    pub lead_deg: f64,
    /// Crosstalk: change of the displacement reading per newton on the foundation [mm/N].
    pub crosstalk_mm_per_n: f64,
}

/// Quantity that a sensor of the oscillator measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sensor {
    /// Displacement of the mass \[mm\].
    Displacement,
    /// Force on the foundation \[N\].
    Force,
}

impl Sensor {
    /// Returns the sensor to which a channel name belongs, and the sensor's unit.
    pub fn named(name: &str) -> Option<(Self, &'static str)> {
        match name {
            "displacement" => Some((Self::Displacement, "mm")),
            "force" => Some((Self::Force, "N")),
            _ => None,
        }
    }
}

/// Result of a simulation of the oscillator: curves of its sensors, or the cause of failure.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// Curve of each requested channel, up to the time at which the simulation ended.
    pub curves: Vec<Vec<f64>>,
    /// Reason why the simulation ended early; `None` if it did not.
    pub failed: Option<&'static str>,
    /// Number of intervals of sliding or standstill that the motion consists of.
    pub pieces: usize,
}

/// Failure kind: the oscillator's mass strikes the stop.
pub const STRIKES: &str = "strikes_the_stop";
/// Failure kind: the motion of the oscillator does not become periodic.
pub const NOT_PERIODIC: &str = "no_common_rhythm";

/// Simulates the oscillator and returns the curves of the channels. Each channel is a sensor with its
/// abscissa values: degrees of the shaker's turn, or seconds after the release.
pub fn run(
    rig: &RigSettings,
    excitation: &Excitation,
    values: &Values,
    effects: &Effects,
    channels: &[(Sensor, &[f64])],
) -> Run {
    let oscillator = Oscillator {
        mass: values.mass_kg + values.armature_kg,
        stiffness: 1e3 * (values.left_n_per_mm + values.right_n_per_mm),
        damping: values.damping_n_s_per_m,
        friction: effects.friction_n,
        lag: 1e-3 * effects.lag_ms,
    };
    let (motion, seconds) = match excitation.drive_hz {
        Some(hz) => {
            let drive = drive(excitation, hz, values.lead_deg, effects);
            (oscillator.steady(&drive, 1.0 / hz), 1.0 / hz / 360.0)
        }
        None => (released(&oscillator, excitation, channels), 1.0),
    };
    let Ok(motion) = motion else {
        let curves = vec![Vec::new(); channels.len()];
        return Run {
            curves,
            failed: Some(NOT_PERIODIC),
            pieces: 0,
        };
    };
    let mut struck = false;
    let curve = |&(sensor, places): &(Sensor, &[f64])| {
        let mut curve = Vec::with_capacity(places.len());
        for place in places {
            let Some(state) = motion.state(place * seconds) else {
                break;
            };
            if 1e3 * state.x.abs() > rig.stop_mm {
                struck = true;
                break;
            }
            curve.push(reading(sensor, &state, values));
        }
        curve
    };
    let curves = channels.iter().map(curve).collect();
    Run {
        curves,
        failed: struck.then_some(STRIKES),
        pieces: motion.pieces(),
    }
}

/// Computes the reading of a sensor in a state, including crosstalk.
fn reading(sensor: Sensor, state: &State, values: &Values) -> f64 {
    match sensor {
        Sensor::Displacement => 1e3 * state.x + values.crosstalk_mm_per_n * state.reading,
        Sensor::Force => state.reading,
    }
}

/// Builds the shaker's force and the foundation's motion as functions of time.
fn drive(excitation: &Excitation, hz: f64, lead_deg: f64, effects: &Effects) -> Drive {
    let turn = TAU * hz;
    let lead = lead_deg.to_radians();
    let wave = |order: u32, amplitude: f64, phase: f64| {
        let order = f64::from(order);
        Sum::cosine(amplitude, order * turn, phase + order * lead)
    };
    let both = |order: u32, [cosine, sine]: [f64; 2]| {
        wave(order, cosine, 0.0).plus(&wave(order, sine, -0.25 * TAU))
    };
    let stated = excitation.drive.iter();
    let force = stated.fold(Sum::default(), |sum, part| {
        sum.plus(&wave(
            part.order,
            part.amplitude_n,
            part.phase_deg.to_radians(),
        ))
    });
    Drive {
        force: force.plus(&both(2, effects.second_order_n)),
        base: both(1, effects.base_mm.map(|mm| 1e-3 * mm)),
    }
}

/// Computes the motion of a mass that is displaced, held and released.
fn released(
    oscillator: &Oscillator,
    excitation: &Excitation,
    channels: &[(Sensor, &[f64])],
) -> Result<crate::motion::Motion, crate::motion::NotPeriodic> {
    let x = 1e-3 * excitation.release_mm;
    let start = State {
        x,
        v: 0.0,
        reading: oscillator.stiffness * x,
    };
    let places = channels
        .iter()
        .flat_map(|(_, places)| places.iter().copied());
    oscillator.integrate(&Drive::default(), start, places.fold(0.0, f64::max))
}
