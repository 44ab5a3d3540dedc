//! Conversion of the back head's tables for the simulation: equally spaced stations in radians, stress in
//! pascals.
use protocol::{
    job::Failure,
    pumping_unit::{Machine, StressRecovery},
};
use simulation::model::description::{self, Head};

pub(super) const PASCAL_PER_MEGAPASCAL: f64 = 1e6;

/// Converts the reduced head of a case for the simulation.
///
/// # Errors
/// [`Failure::Misconfigured`] naming the table whose stations are not equally spaced.
pub(super) fn head(machine: &Machine) -> Result<Head, Failure> {
    let head = &machine.modal_head;
    let (start, step) = grid("modal_head.arc_deg", &head.arc_deg)?;
    let (influence_start, influence_step) = grid("influence.psi_deg", &head.influence.psi_deg)?;
    let base_stress = head
        .inertia_stress_mpa
        .map(|row| row.map(|s| s * PASCAL_PER_MEGAPASCAL));
    Ok(Head {
        frequencies: head
            .frequencies_hz
            .iter()
            .map(|f| f * std::f64::consts::TAU)
            .collect(),
        damping_ratio: head.damping_ratio,
        recovery: match head.stress {
            StressRecovery::ModeAcceleration => description::StressRecovery::ModeAcceleration,
            StressRecovery::ModeDisplacement => description::StressRecovery::ModeDisplacement,
        },
        start,
        step,
        radial: head.radial.clone(),
        tangential: head.tangential.clone(),
        gauge_stress: head
            .gauge_stress_mpa
            .iter()
            .map(|row| row.map(|s| s * PASCAL_PER_MEGAPASCAL))
            .collect(),
        participation: head.participation.clone(),
        weight_stress: [base_stress[0], base_stress[1]],
        turning_stress: base_stress[2],
        influence_start,
        influence_step,
        load_breaks: machine
            .load_breaks_deg()
            .iter()
            .map(|x| x.to_radians())
            .collect(),
        normal_influence: curves(&head.influence.normal_mpa_per_n),
        tangential_influence: curves(&head.influence.tangential_mpa_per_n),
    })
}

/// Converts influence lines to one curve per gauge \[Pa/N\].
pub(super) fn curves(rows: &[[f64; 4]]) -> Vec<Vec<f64>> {
    let line = |gauge: usize| {
        rows.iter()
            .map(move |row| row[gauge] * PASCAL_PER_MEGAPASCAL)
    };
    (0..4).map(|gauge| line(gauge).collect()).collect()
}

/// Returns the first station and the spacing \[rad\] of a table over the head's arc, whose stations must be
/// equally spaced.
fn grid(field: &str, degrees: &[f64]) -> Result<(f64, f64), Failure> {
    let [first, second, ..] = degrees else {
        return Err(Failure::misconfigured(field, "needs at least two stations"));
    };
    let step = second - first;
    let even = degrees
        .iter()
        .enumerate()
        .all(|(i, x)| (x - first - step * i as f64).abs() < 1e-6 * step.abs());
    if !(even && step > 0.0) {
        return Err(Failure::misconfigured(
            field,
            "must ascend in equal steps; resample the table",
        ));
    }
    Ok((first.to_radians(), step.to_radians()))
}
