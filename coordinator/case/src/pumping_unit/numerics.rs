//! Numerical settings (discretisation in space and time) of the simulations of a diagnosis.
use discrepancy::{baseline::discretisation_check::FinerModel, thresholds::Thresholds};
use protocol::{
    case::Case,
    job::Numerics,
    pumping_unit::{Discretisation, Machine},
    wire::WireError,
};

/// Returns the numerical settings for the simulations of a diagnosis, and those for its check of the
/// discretisation error: everything refined, only the cylinders of the ropes refined, everything else
/// refined.
///
/// # Errors
/// Returns an error for a case of another kind.
pub(super) fn numerics(
    case: &Case,
    thresholds: &Thresholds,
) -> Result<(Numerics, Vec<FinerModel>), WireError> {
    let machine = Machine::of(case)?;
    let available = machine.modal_head.frequencies_hz.len();
    let usual = Discretisation {
        longest_step_s: Some(thresholds.step * machine.run.longest_step_s),
        ..Discretisation::default()
    };
    let finest = Discretisation {
        cylinder_length_m: Some(machine.ropes.cylinder_length_m * thresholds.refinement),
        lead_in_deg: Some(machine.run.lead_in_deg + 180.0),
        modes: Some((machine.run.modes + 2).min(available)),
        longest_step_s: Some(0.5 * thresholds.step * machine.run.longest_step_s),
        ..Discretisation::OF_THE_CASE
    };
    let cylinders = Discretisation {
        cylinder_length_m: finest.cylinder_length_m,
        ..usual
    };
    let rest = Discretisation {
        cylinder_length_m: usual.cylinder_length_m,
        ..finest
    };
    let ropes = &machine.ropes;
    // a rope keeps its length
    let count = |cylinders: usize| (cylinders as f64 / thresholds.refinement).round();
    let of_cylinders = format!(
        "`ropes.cylinder_length_m = {}`, `ropes.back_cylinders = {}` and `ropes.front_cylinders = {}`",
        ropes.cylinder_length_m * thresholds.refinement,
        count(ropes.back_cylinders),
        count(ropes.front_cylinders),
    );
    let of_rest = format!(
        "`run.longest_step_s = {}`, `run.lead_in_deg = {}` and `run.modes = {}`",
        0.5 * machine.run.longest_step_s,
        machine.run.lead_in_deg + 180.0,
        (machine.run.modes + 2).min(available),
    );
    let finer = [
        (finest, format!("{of_cylinders}, {of_rest}")),
        (cylinders, of_cylinders),
        (rest, of_rest),
    ];
    let finer = finer.map(|(discretisation, settings)| {
        let numerics = discretisation.numerics()?;
        Ok(FinerModel { numerics, settings })
    });
    Ok((
        usual.numerics()?,
        finer.into_iter().collect::<Result<_, _>>()?,
    ))
}
