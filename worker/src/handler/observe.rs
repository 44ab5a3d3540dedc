//! Simulates an individual and returns the measured channels alone, on demand with another
//! discretisation than the case's.
use crate::convert;
use crate::handler::Prepared;
use protocol::job::{Failure, Observation, ObserveSpec};
use simulation::observe::Recorder;
use simulation::run::simulate;

/// Runs an observe job.
///
/// # Errors
/// [`Failure::Misconfigured`] when genes, condition, effects or refinement do not fit the case.
pub(super) fn run(prepared: &Prepared, spec: &ObserveSpec) -> Result<Observation, Failure> {
    let refined = convert::refined(&prepared.case, &spec.refinement)?;
    let law = convert::rope_law(&refined, &spec.genes)?;
    let settings = convert::run_settings(&refined);
    let individual = (spec.genes.as_slice(), spec.effects.as_slice());
    let plain = refined == prepared.case;
    let machine = if plain {
        prepared.machine_with(spec.condition, individual)?
    } else {
        std::borrow::Cow::Owned(convert::machine_with(&refined, spec.condition, individual)?)
    };
    let mut recorder = Recorder::everything(0);
    let result = simulate(&machine, &law, &settings, &mut recorder);
    let height = machine.lowest_suspension;
    let curves = recorder.curves;
    Ok(Observation {
        verdict: convert::verdict(&result.verdict),
        counters: convert::counters(&result.statistics),
        gauge_mpa: curves
            .gauge
            .map(|curve| curve.iter().map(|s| s * 1e-6).collect()),
        suspension_m: curves.suspension[0].iter().map(|y| y - height).collect(),
        crank_torque_n_m: curves.torque,
    })
}
