//! Data of the figures of `horsehead balance`.
use super::{
    options::BalancePlan,
    output::measured,
    summary::AssessedCrank,
    torque::{Counterweight, Revolution},
};
use protocol::{case::Case, pumping_unit::Machine};
use report::pumping_unit::{BalanceMap, CrankBalancePicture, CrankTorque};
use std::f64::consts::TAU;

/// Share of the present moment, to either side, that the map of moment and phase shows at least.
const MAP_MOMENT: f64 = 0.25;
/// Phase to either side of the present that the map shows at least \[deg\].
const MAP_PHASE_DEG: f64 = 15.0;
/// Number of moments, and of phases, of the map.
const MAP_CELLS: usize = 41;

/// Collects the data of the figures.
pub(super) fn picture<'a>(
    (case, machine): (&'a Case, &Machine),
    (plan, revolutions): (&'a BalancePlan, &[Revolution]),
    (present, optimum): (&'a AssessedCrank, &'a AssessedCrank),
) -> CrankBalancePicture<'a> {
    let states = present.states.iter().zip(&optimum.states);
    let conditions = plan.operations.iter().zip(states);
    let conditions = conditions.map(|(operation, (before, after))| CrankTorque {
        name: &operation.name,
        speed: TAU * machine.conditions[operation.condition].speed_rpm / 60.0,
        present: (&before.turn_deg, &before.torque_n_m),
        best: (&after.turn_deg, &after.torque_n_m),
        measured: measured(case, operation.condition),
    });
    CrankBalancePicture {
        rating_n_m: plan.rating_n_m,
        conditions: conditions.collect(),
        map: map(plan, revolutions, optimum.best),
    }
}

/// Computes the goal over moments and phases about the present and the best counterweight.
fn map(plan: &BalancePlan, revolutions: &[Revolution], best: Counterweight) -> BalanceMap {
    let all = || plan.present.iter().chain([&best]);
    let ends = |of: fn(&Counterweight) -> f64, about: &dyn Fn(f64) -> f64| {
        let low = all().map(|own| of(own) - about(of(own)));
        let high = all().map(|own| of(own) + about(of(own)));
        (
            low.fold(f64::INFINITY, f64::min),
            high.fold(f64::NEG_INFINITY, f64::max),
        )
    };
    let spaced = |(low, high): (f64, f64)| -> Vec<f64> {
        let step = (high - low) / (MAP_CELLS - 1) as f64;
        (0..MAP_CELLS).map(|k| low + step * k as f64).collect()
    };
    let moments_n_m = spaced(ends(|own| own.moment_n_m, &|moment| MAP_MOMENT * moment));
    let phases_deg = spaced(ends(|own| own.phase_deg, &|_| MAP_PHASE_DEG));
    let row = |&phase_deg: &f64| -> Vec<f64> {
        let value = |&moment_n_m: &f64| {
            let weight = Counterweight {
                moment_n_m,
                phase_deg,
            };
            plan.goal.value(revolutions, weight)
        };
        moments_n_m.iter().map(value).collect()
    };
    let place = |own: &Counterweight| (own.moment_n_m, own.phase_deg);
    BalanceMap {
        goal: plan.goal.name(),
        values_n_m: phases_deg.iter().map(row).collect(),
        moments_n_m,
        phases_deg,
        present: plan.present.iter().map(place).collect(),
        best: place(&best),
    }
}
