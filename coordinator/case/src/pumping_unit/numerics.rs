//! Numerical settings (discretisation in space and time) of the simulations of a diagnosis.
use protocol::{
    case::Case,
    job::Numerics,
    pumping_unit::{Discretisation, Machine},
    wire::WireError,
};

/// Number of times the iteration budget of the case that a simulation of a diagnosis has. A machine that is given up is a
/// hole in the misfit, at whose edge a fit ends: with the budget of the case, 1,717 of 4,600 simulations of practice
/// set 2 were given up, and the answer with them under the other condition; with four times as many, 134 of 3,721.
const BUDGET_FACTOR: u64 = 4;

/// Returns the numerical settings for the simulations of a diagnosis, and those for its check of the
/// discretisation error: everything refined, only the cylinders of the ropes refined, everything else
/// refined.
///
/// # Errors
/// Returns an error for a case of another kind.
pub(super) fn numerics(
    case: &Case,
    step: f64,
    refinement: f64,
) -> Result<(Numerics, Vec<Numerics>), WireError> {
    let machine = Machine::of(case)?;
    let available = machine.modal_head.frequencies_hz.len();
    let usual = Discretisation {
        longest_step_s: Some(step * machine.run.longest_step_s),
        budget: Some(BUDGET_FACTOR.saturating_mul(machine.run.iteration_budget)),
        ..Discretisation::default()
    };
    let finest = Discretisation {
        cylinder_length_m: Some(machine.ropes.cylinder_length_m * refinement),
        lead_in_deg: Some(machine.run.lead_in_deg + 180.0),
        modes: Some((machine.run.modes + 2).min(available)),
        longest_step_s: Some(0.5 * step * machine.run.longest_step_s),
        budget: usual.budget.map(|own| own.saturating_mul(2)),
        ..usual
    };
    let cylinders = Discretisation {
        cylinder_length_m: finest.cylinder_length_m,
        ..usual
    };
    let rest = Discretisation {
        cylinder_length_m: usual.cylinder_length_m,
        ..finest
    };
    let finer = [finest, cylinders, rest].map(|one| one.numerics());
    Ok((
        usual.numerics()?,
        finer.into_iter().collect::<Result<_, _>>()?,
    ))
}

/// Returns the lines of the case file that make elements, steps and modes of the case as fine as in the finest of
/// [`numerics`]. A rope keeps its length; the longer lead-in is left out.
///
/// # Errors
/// As [`numerics`].
pub(super) fn finer_settings(case: &Case, refinement: f64) -> Result<Vec<String>, WireError> {
    let machine = Machine::of(case)?;
    let (ropes, run) = (&machine.ropes, &machine.run);
    let available = machine.modal_head.frequencies_hz.len();
    let count = |cylinders: usize| (cylinders as f64 / refinement).round();
    Ok(vec![
        format!(
            "ropes.cylinder_length_m = {}",
            ropes.cylinder_length_m * refinement
        ),
        format!("ropes.back_cylinders = {}", count(ropes.back_cylinders)),
        format!("ropes.front_cylinders = {}", count(ropes.front_cylinders)),
        format!("run.longest_step_s = {}", 0.5 * run.longest_step_s),
        format!("run.modes = {}", (run.modes + 2).min(available)),
    ])
}
