//! Positions of the machine's moving bodies at a sample, with rope tensions and contact forces.
use super::curves::Shape;
use crate::drive::DriveState;
use crate::math::elementary::sin_cos;
use crate::model::RopeMachine;
use crate::model::chain::ChainState;
use crate::system::State;

/// Returns the machine's shape and loads at a sample.
pub(super) fn shape(
    sample: usize,
    system: &RopeMachine<'_>,
    drive: &DriveState,
    state: &State,
) -> Shape {
    let machine = system.machine;
    let layout = machine.layout;
    let (s, c) = sin_cos(state.q[layout.rod()]);
    let length = machine.description.rod.length;
    let [pin, ..] = drive.pin;
    let centers = [0, 1].map(|rope| {
        state.q[machine.chain_on(rope).range()]
            .chunks_exact(layout.motion.width())
            .map(|q| [q[0], q[1]])
            .collect()
    });
    // sums over the ropes of a head
    let summed = |rope: usize, each: &dyn Fn(&ChainState, usize) -> f64| -> Vec<f64> {
        let all = machine.strands.iter().zip(&system.scratch.chains);
        let on_head: Vec<&ChainState> = all
            .filter(|(strand, _)| strand.rope == rope)
            .map(|(_, state)| state)
            .collect();
        (0..machine.chain_on(rope).count)
            .map(|j| on_head.iter().map(|state| each(state, j)).sum())
            .collect()
    };
    let tension = |state: &ChainState, joint: usize| {
        if joint == 0 {
            state.joints[0].force.norm()
        } else {
            state.tension(joint)
        }
    };
    Shape {
        sample,
        pin: pin.into(),
        crossbeam: [pin.x + length * c, pin.y + length * s],
        beam: state.q[layout.beam()],
        suspension: [machine.suspension_x, state.q[layout.suspension()]],
        centers,
        tension: [0, 1].map(|rope| summed(rope, &tension)),
        contact: [0, 1].map(|rope| summed(rope, &|state, j| state.contact[j])),
    }
}
