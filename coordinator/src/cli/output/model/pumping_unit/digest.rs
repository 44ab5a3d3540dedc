//! Digest of a simulated revolution of the pumping unit: equal digests mean bitwise equal results.
use super::super::digest::Digest;
use protocol::pumping_unit::Simulation;

/// Computes the digest over verdict, counters and every number of the curves; wall time and the recorded
/// motion of the bodies are left out.
pub(crate) fn simulation_digest(simulation: &Simulation) -> String {
    let mut digest = Digest::of(simulation.verdict);
    let single = [
        &simulation.turn_deg,
        &simulation.back_rope_tension_n,
        &simulation.front_rope_tension_n,
        &simulation.beam_deg,
        &simulation.suspension_m,
        &simulation.suspension_velocity_m_s,
        &simulation.suspension_acceleration_m_s2,
        &simulation.crank_torque_n_m,
    ];
    let curves = single
        .into_iter()
        .chain(&simulation.gauge_mpa)
        .chain(&simulation.modal)
        .chain(
            simulation
                .tension_difference_n
                .iter()
                .filter(|curve| !curve.is_empty()),
        );
    for curve in curves {
        digest.curve(curve);
    }
    let energy = simulation.energy;
    for value in [
        energy.input_j,
        energy.output_j,
        energy.dissipated_j,
        energy.stored_j,
        energy.relative_error,
    ] {
        digest.number(value);
    }
    digest.end(simulation.verdict, &simulation.counters)
}
