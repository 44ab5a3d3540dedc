//! Everything of a simulation that can be drawn.
use super::Sensor;
use crate::{
    job::{Counters, Curves, Verdict},
    wire::{self, WireError},
};
use serde::{Deserialize, Serialize};

/// Curves of one revolution; every vector has one entry per crank angle reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    /// How it ended.
    pub verdict: Verdict,
    /// What it cost.
    pub counters: Counters,
    /// Wall time on the worker \[s\]; not part of the digest.
    pub wall_s: f64,
    /// Crank angle from bottom dead centre \[deg\].
    pub turn_deg: Vec<f64>,
    /// Stress at gauges 1 to 4 \[MPa\].
    pub gauge_mpa: [Vec<f64>; 4],
    /// Axial force in the back rope's first joint, at the crossbeam; of two ropes together \[N\].
    pub back_rope_tension_n: Vec<f64>,
    /// Axial force in the front rope's joint at the suspension; of two ropes together \[N\].
    pub front_rope_tension_n: Vec<f64>,
    /// By how much of two ropes the one at +z pulls more, back and front \[N\]; empty where there is
    /// one.
    pub tension_difference_n: [Vec<f64>; 2],
    /// Beam angle \[deg\].
    pub beam_deg: Vec<f64>,
    /// Suspension height above its lowest design position \[m\].
    pub suspension_m: Vec<f64>,
    /// Suspension velocity [m/s].
    pub suspension_velocity_m_s: Vec<f64>,
    /// Suspension acceleration [m/s2].
    pub suspension_acceleration_m_s2: Vec<f64>,
    /// Net torque at the crank shaft, counterweight included [N m].
    pub crank_torque_n_m: Vec<f64>,
    /// Modal coordinates of the back head, mode by mode [kg^1/2 m].
    pub modal: Vec<Vec<f64>>,
    /// Energy over the recorded revolution.
    pub energy: Energy,
    /// Shapes for the moving machine; empty unless asked for.
    pub motion: Vec<Motion>,
}

impl Simulation {
    /// The curve of a channel by its name; empty where a pumping unit has none of that name.
    pub fn channel(&self, name: &str) -> &[f64] {
        match Sensor::named(name) {
            Some(Sensor::Gauge(number)) => &self.gauge_mpa[usize::from(number) - 1],
            Some(Sensor::Position) => &self.suspension_m,
            Some(Sensor::Torque) => &self.crank_torque_n_m,
            None => &[],
        }
    }

    /// What the model of a pumping unit says beside the channels.
    ///
    /// # Errors
    /// [`WireError`] where another model drew them.
    pub fn of(curves: &Curves) -> Result<Self, WireError> {
        wire::decode(&curves.details)
    }

    /// As it travels, with the curves of the channels.
    ///
    /// # Errors
    /// [`WireError::TooLong`] beyond what a message may hold.
    pub fn into_curves(self, channels: Vec<Vec<f64>>) -> Result<Curves, WireError> {
        Ok(Curves {
            verdict: self.verdict,
            counters: self.counters,
            wall_s: self.wall_s,
            channels,
            columns: Vec::new(),
            columns_wall_s: 0.0,
            details: wire::encode(&self)?,
        })
    }
}

/// Where the energy of the recorded revolution went \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Work of the crank pin on the rod.
    pub input_j: f64,
    /// Work on the polished-rod load.
    pub output_j: f64,
    /// Lost in rope joints, contact and head damping.
    pub dissipated_j: f64,
    /// Gain of kinetic, gravitational and elastic energy.
    pub stored_j: f64,
    /// |input - output - dissipated - stored| over the larger of input and output work.
    pub relative_error: f64,
}

/// One snapshot of the machine in the ground frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Crank angle from bottom dead centre \[deg\].
    pub turn_deg: f64,
    /// Crank pin x, y \[m\].
    pub crank_pin_m: [f32; 2],
    /// Beam angle \[deg\].
    pub beam_deg: f32,
    /// Crossbeam end of the rod x, y \[m\].
    pub crossbeam_m: [f32; 2],
    /// Suspension point x, y \[m\].
    pub suspension_m: [f32; 2],
    /// Centres of the back rope's cylinders from the crossbeam on, x, y \[m\].
    pub back_rope_m: Vec<[f32; 2]>,
    /// Axial force in the joint before each of those cylinders \[N\].
    pub back_tension_n: Vec<f32>,
    /// Contact force on each of those cylinders \[N\].
    pub back_contact_n: Vec<f32>,
    /// Centres of the front rope's cylinders from the suspension on, x, y \[m\].
    pub front_rope_m: Vec<[f32; 2]>,
    /// Axial force in the joint before each of those cylinders \[N\].
    pub front_tension_n: Vec<f32>,
    /// Contact force on each of those cylinders \[N\].
    pub front_contact_n: Vec<f32>,
}
