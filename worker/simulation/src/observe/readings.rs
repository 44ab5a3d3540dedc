//! Gauge readings at a state: stress of the back head, and the measuring chain from stress to recorded value.
use super::stress::gauge_stress;
use crate::model::RopeMachine;
use crate::model::extension::SampleState;
use crate::model::parallel_ropes::BACK;
use crate::system::State;

/// Returns the readings of the four gauges \[Pa\] at a sample of the recorded revolution.
///
/// With `part` only the loads that the head's stress depends on are computed; all other loads, needed for
/// reading extensions and curves, are undefined. `force` is workspace for generalised forces.
pub(crate) fn readings(
    individual: &mut RopeMachine<'_>,
    state: &State,
    force: &mut [f64],
    part: bool,
) -> [f64; 4] {
    let mut stress = recovered_stress(individual, state, force, part);
    let extensions = &individual.machine.extensions;
    if extensions.has_readings() {
        extensions.read(&sampled(individual, state), &mut stress);
    }
    stress
}

/// Returns the stress at the four gauges \[Pa\], before the measuring chain; arguments as for [`readings`].
pub(crate) fn recovered_stress(
    individual: &mut RopeMachine<'_>,
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
    gauge_stress(&loads, &state.a)
}

/// Returns the quantities that stages of the measuring chain may use, at a state for which the individual
/// holds all loads.
pub(crate) fn sampled(individual: &RopeMachine<'_>, state: &State) -> SampleState {
    let machine = individual.machine;
    let recorded = individual.drive.turn(state.t)[0] - machine.extensions.index_offset();
    SampleState {
        head_force: individual.head_push(),
        back_tension: individual.base_tensions(BACK).sum(),
        joint_stiffness: individual.ropes.joint.stiffness[0],
        beam: state.q[machine.layout.beam()],
        elapsed: recorded / std::f64::consts::TAU,
    }
}
