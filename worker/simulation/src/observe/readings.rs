//! What the gauges read of a state: stress of the back head, and the chain from there to the record.
use super::stress::gauge_stress;
use crate::model::Individual;
use crate::model::hook::Sampled;
use crate::model::strand::BACK;
use crate::system::State;

/// Readings of the four gauges \[Pa\] at a sample of the recorded revolution.
///
/// `part`: only the loads that the head's stress asks for are filled; what readings and curves ask for
/// beyond that is unknown. `force` is room for generalised forces.
pub(crate) fn readings(
    individual: &mut Individual<'_>,
    state: &State,
    force: &mut [f64],
    part: bool,
) -> [f64; 4] {
    let at = state.motion();
    let loads = if part {
        individual.back_head_loads(at, force)
    } else {
        individual.all_loads(at, force)
    };
    let mut stress = gauge_stress(&loads, &state.a);
    let hooks = &individual.machine.hooks;
    if hooks.has_readings() {
        hooks.read(&sampled(individual, state), &mut stress);
    }
    stress
}

/// What readings may know of a state, all of whose loads an individual has.
pub(crate) fn sampled(individual: &Individual<'_>, state: &State) -> Sampled {
    let machine = individual.machine;
    let recorded = individual.drive.turn(state.t)[0] - machine.hooks.index_offset();
    Sampled {
        head_push: individual.head_push(),
        back_tension: individual.base_tensions(BACK).sum(),
        joint_stiffness: individual.ropes.joint.stiffness[0],
        beam: state.q[machine.layout.beam()],
        elapsed: recorded / std::f64::consts::TAU,
    }
}
