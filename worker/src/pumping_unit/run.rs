//! Settings of a pumping unit's run: start, sampling and integration.
use protocol::pumping_unit::{Discretisation, Integrator, Machine};
use simulation::integrator::method::Method;
use simulation::integrator::tableau::{ESDIRK4, TR_BDF2};
use simulation::run::RunSettings;

/// Returns the run settings of a case.
pub fn run_settings(machine: &Machine) -> RunSettings {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "the case check lets only steps through that divide 360"
    )]
    let samples = (360.0 / machine.run.output_step_deg).round() as usize;
    RunSettings {
        lead_in: machine.run.lead_in_deg.to_radians(),
        ramp: machine.run.ramp_s,
        samples,
        tolerance: machine.run.tolerance,
        method: method(machine.run.integrator),
        longest_step: machine.run.longest_step_s,
        budget: machine.run.iteration_budget,
        ..RunSettings::default()
    }
}

/// Returns the run settings of a case whose discretisation a job replaces; `machine` must be the
/// [`super::refined`] one.
pub(super) fn discretised_settings(
    machine: &Machine,
    discretisation: &Discretisation,
) -> RunSettings {
    let mut settings = run_settings(machine);
    if discretisation.step_as_stated {
        settings.slow_swing = f64::INFINITY;
    }
    if let Some(budget) = discretisation.budget {
        settings.budget = budget;
    }
    settings
}

const fn method(integrator: Integrator) -> Method {
    match integrator {
        Integrator::TrBdf2 => Method::RungeKutta(&TR_BDF2),
        Integrator::Esdirk4 => Method::RungeKutta(&ESDIRK4),
    }
}
