//! The measured channels of a simulation.
use super::machines::Machines;
use super::ran::Ran;
use protocol::job::{Failure, Observation, SimulateSpec};
use simulation::observe::Recorder;

/// Simulates.
///
/// # Errors
/// As [`Ran::new`].
pub(super) fn run(machines: &Machines, spec: &SimulateSpec) -> Result<Observation, Failure> {
    let ran = Ran::new(machines, spec, Recorder::everything(0))?;
    let exact = Observation {
        verdict: ran.verdict,
        counters: ran.counters,
        gauge_mpa: ran.gauge_mpa(),
        suspension_m: ran.suspension_m(),
        crank_torque_n_m: ran.curves.torque,
    };
    Ok(exact.rounded())
}
