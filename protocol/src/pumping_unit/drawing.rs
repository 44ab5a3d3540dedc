//! Curves and snapshots of a simulated pumping unit, for plots and animations.
use super::{HeadLoads, Sensor};
use crate::{
    job::{Counters, Curves, Verdict},
    wire::{self, WireError},
};
use serde::{Deserialize, Serialize};

/// Curves of a simulated pumping unit over one crank revolution, one value per crank angle reached.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Simulation {
    /// Verdict of the simulation.
    pub verdict: Verdict,
    /// Work counters of the simulation.
    pub counters: Counters,
    /// Wall time of the simulation on the worker \[s\]; not part of the digest of results.
    pub wall_s: f64,
    /// Crank angle from bottom dead centre \[deg\].
    pub turn_deg: Vec<f64>,
    /// Stress at gauges 1 to 4 \[MPa\].
    pub gauge_mpa: [Vec<f64>; 4],
    /// Axial force in the first joint of the back rope, at the crossbeam; sum of both ropes on a twin-rope
    /// machine \[N\].
    pub back_rope_tension_n: Vec<f64>,
    /// Axial force in the front rope's joint at the suspension; sum of both ropes on a twin-rope machine
    /// \[N\].
    pub front_rope_tension_n: Vec<f64>,
    /// Tension of the rope at +z minus that at -z on a twin-rope machine, back and front \[N\]; empty with
    /// single ropes.
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
    /// Loads of the back head, from which its stress anywhere follows.
    pub head_loads: HeadLoads,
    /// Energy balance of the recorded revolution.
    pub energy: Energy,
    /// Snapshots of the moving machine; empty unless requested.
    pub motion: Vec<MachineSnapshot>,
}

impl Simulation {
    /// Returns the curve of the channel with that name; empty if a pumping unit has no such channel.
    pub fn channel(&self, name: &str) -> &[f64] {
        match Sensor::named(name) {
            Some(Sensor::Gauge(number)) => &self.gauge_mpa[usize::from(number) - 1],
            Some(Sensor::Position) => &self.suspension_m,
            Some(Sensor::Torque) => &self.crank_torque_n_m,
            None => &[],
        }
    }

    /// Decodes a pumping unit's simulation from the model-specific part of a job's answer.
    ///
    /// # Errors
    /// [`WireError`] if the curves come from another kind of model.
    pub fn of(curves: &Curves) -> Result<Self, WireError> {
        wire::decode(&curves.details)
    }

    /// Encodes the simulation as the model-specific part of a job's answer, next to the given channel curves.
    ///
    /// # Errors
    /// [`WireError::TooLong`] beyond the size limit of a message.
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

/// Energy balance of a pumping unit over the recorded revolution \[J\].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Work of the crank pin on the connecting rod \[J\].
    pub input_j: f64,
    /// Work done on the polished-rod load \[J\].
    pub output_j: f64,
    /// Energy dissipated in rope joints, contact and head damping \[J\].
    pub dissipated_j: f64,
    /// Increase of kinetic, gravitational and elastic energy \[J\].
    pub stored_j: f64,
    /// |input - output - dissipated - stored| over the larger of input and output work \[1\].
    pub relative_error: f64,
}

/// Positions and rope forces of the moving machine at one crank angle, in the ground frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineSnapshot {
    /// Crank angle from bottom dead centre \[deg\].
    pub turn_deg: f64,
    /// Position of the crank pin, x and y \[m\].
    pub crank_pin_m: [f32; 2],
    /// Beam angle \[deg\].
    pub beam_deg: f32,
    /// Position of the connecting rod's end at the crossbeam, x and y \[m\].
    pub crossbeam_m: [f32; 2],
    /// Position of the suspension point, x and y \[m\].
    pub suspension_m: [f32; 2],
    /// Positions (x, y) of the centres of the back rope's cylinders, beginning at the crossbeam \[m\].
    pub back_rope_m: Vec<[f32; 2]>,
    /// Axial force in the joint before each cylinder of the back rope \[N\].
    pub back_tension_n: Vec<f32>,
    /// Contact force on each cylinder of the back rope \[N\].
    pub back_contact_n: Vec<f32>,
    /// Positions (x, y) of the centres of the front rope's cylinders, beginning at the suspension \[m\].
    pub front_rope_m: Vec<[f32; 2]>,
    /// Axial force in the joint before each cylinder of the front rope \[N\].
    pub front_tension_n: Vec<f32>,
    /// Contact force on each cylinder of the front rope \[N\].
    pub front_contact_n: Vec<f32>,
}
