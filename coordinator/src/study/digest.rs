//! The digest of a simulation: two runs with the same digest have the same bits.
use protocol::{
    job::{Reached, Verdict},
    pumping_unit::Simulation,
};

/// BLAKE3 over verdict, counters and every number of the curves, little endian; 64 hexadecimal
/// digits. Wall time and the shapes of the moving machine are left out.
pub fn simulation_digest(simulation: &Simulation) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut number = |value: f64| {
        hasher.update(&value.to_bits().to_le_bytes());
    };
    let mut word = String::from("complete");
    if let Verdict::Failed { kind, reached } = simulation.verdict {
        kind.as_str().clone_into(&mut word);
        match reached {
            Reached::LoadFraction(share) | Reached::TimeFraction(share) => number(share),
        }
    }
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
        number(curve.len() as f64);
        curve.iter().copied().for_each(&mut number);
    }
    let energy = simulation.energy;
    for value in [
        energy.input_j,
        energy.output_j,
        energy.dissipated_j,
        energy.stored_j,
        energy.relative_error,
    ] {
        number(value);
    }
    for (_, _, count) in simulation.counters.named() {
        hasher.update(&count.to_le_bytes());
    }
    hasher.update(word.as_bytes());
    hasher.finalize().to_hex().to_string()
}
