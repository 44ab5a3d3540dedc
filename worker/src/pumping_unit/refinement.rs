//! Refinement of a case: the same machine with another discretisation of its ropes.
use protocol::{
    job::Failure,
    pumping_unit::{Discretisation, PumpingUnit},
};

/// Returns a case whose ropes are divided into cylinders of another length.
///
/// # Errors
/// [`Failure::Misconfigured`] when cylinders of that length do not fill the ropes exactly.
pub fn refined(
    unit: &PumpingUnit,
    discretisation: &Discretisation,
) -> Result<PumpingUnit, Failure> {
    let mut unit = unit.clone();
    let machine = &mut unit.machine;
    if let Some(length) = discretisation.cylinder_length_m {
        for count in [
            &mut machine.ropes.back_cylinders,
            &mut machine.ropes.front_cylinders,
        ] {
            let rope = *count as f64 * machine.ropes.cylinder_length_m;
            let fitting = (rope / length).round();
            let fits = (3.0..=MOST_CYLINDERS).contains(&fitting)
                && (fitting * length - rope).abs() < 1e-6 * rope;
            if !fits {
                return Err(Failure::misconfigured(
                    "discretisation.cylinder_length_m",
                    format!("is {length}; it must divide a rope of {rope} m into 3 to 5000 parts"),
                ));
            }
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a whole number between the limits above"
            )]
            let fitting = fitting as usize;
            *count = fitting;
        }
        machine.ropes.cylinder_length_m = length;
    }
    if let Some(modes) = discretisation.modes {
        if modes > machine.modal_head.frequencies_hz.len() {
            return Err(Failure::misconfigured(
                "discretisation.modes",
                format!(
                    "is {modes}; the head has {}",
                    machine.modal_head.frequencies_hz.len()
                ),
            ));
        }
        machine.run.modes = modes;
    }
    if let Some(integrator) = discretisation.integrator {
        machine.run.integrator = integrator;
    }
    let positive = |field: &str, value: f64| {
        if value > 0.0 && value.is_finite() {
            return Ok(value);
        }
        Err(Failure::misconfigured(
            field,
            format!("is {value}; it must be a positive number"),
        ))
    };
    if let Some(step) = discretisation.longest_step_s {
        machine.run.longest_step_s = positive("discretisation.longest_step_s", step)?;
    }
    if let Some(lead_in) = discretisation.lead_in_deg {
        if !(0.0..=3600.0).contains(&lead_in) {
            return Err(Failure::misconfigured(
                "discretisation.lead_in_deg",
                format!("is {lead_in}; it must lie between 0 and 3600"),
            ));
        }
        machine.run.lead_in_deg = lead_in;
    }
    if let Some(tolerance) = discretisation.tolerance {
        machine.run.tolerance = positive("discretisation.tolerance", tolerance)?;
    }
    Ok(unit)
}

/// Largest number of cylinders that a rope may have.
const MOST_CYLINDERS: f64 = 5000.0;
