//! Measured quantities other than gauge stress: height of the suspension point and net torque at the crank
//! shaft.
use crate::drive::DriveState;
use crate::math::elementary::sin_cos;
use crate::model::{Machine, RopeMachine};
use crate::system::State;
use nalgebra::Vector2;

/// Returns the net torque that the reducer must supply in the sense of rotation, counterweight included [N
/// m].
pub(super) fn crank_torque(machine: &Machine, drive: &DriveState, pin: &Vector2<f64>) -> f64 {
    let crank = &machine.description.crank;
    // the counterweight hangs opposite the pin and falls while the rope is pulled
    let weight = crank.counterweight_moment
        * sin_cos(drive.pin_angle + crank.sense * crank.counterweight_phase).1;
    turning(machine, drive, pin) + crank.sense * weight
}

/// Returns the torque of a force at the crank pin in the sense of rotation [N m].
fn turning(machine: &Machine, drive: &DriveState, force: &Vector2<f64>) -> f64 {
    let crank = &machine.description.crank;
    let (s, c) = sin_cos(drive.pin_angle);
    crank.radius * crank.sense * (force.y * c - force.x * s)
}

/// Returns the height of the suspension point above its lowest design position \[m\] and the net crank torque
/// [N m] at a state.
pub(crate) fn shaft(individual: &mut RopeMachine<'_>, state: &State) -> [f64; 2] {
    let pin = individual.pin_force(state);
    let machine = individual.machine;
    let drive = individual.drive_state(state.t);
    let height = state.q[machine.layout.suspension()] - machine.lowest_suspension;
    [height, crank_torque(machine, &drive, &pin)]
}

/// Returns the crank torque at a state caused by the force of the back ropes alone [N m].
pub(crate) fn turned_by_ropes(individual: &mut RopeMachine<'_>, state: &State) -> f64 {
    let pull = individual.base_pull(state.motion());
    let drive = individual.drive_state(state.t);
    turning(individual.machine, &drive, &pull.xy())
}

/// Finite-difference steps for the crank torque: of a coordinate, of a rate and of an acceleration (the
/// torque is linear in rates and accelerations).
const STEPS: [f64; 3] = [1e-7, 1e-4, 1e-2];

/// Derivatives of the crank torque with respect to the state, as a list: index of the coordinate, derivatives
/// with respect to that coordinate, its rate and its acceleration.
#[derive(Clone, Debug, Default)]
pub(crate) struct TorqueBy(pub(crate) Vec<(usize, [f64; 3])>);

impl TorqueBy {
    /// Computes the derivatives of the crank torque at a state; `room` is a state used as workspace. The
    /// torque depends on the rod and on the first cylinders of the back ropes only.
    pub(crate) fn fill(
        &mut self,
        individual: &mut RopeMachine<'_>,
        state: &State,
        room: &mut State,
    ) {
        let machine = individual.machine;
        let back = machine.chains[..machine.faces.len()].iter();
        let first = back.flat_map(|chain| chain.cylinder(0));
        self.0.clear();
        self.0.extend(
            std::iter::once(machine.layout.rod())
                .chain(first)
                .map(|k| (k, [0.0; 3])),
        );
        room.clone_from(state);
        for (at, by) in &mut self.0 {
            for (part, step) in STEPS.into_iter().enumerate() {
                let mut asked = |step: f64| {
                    let moved = |room: &mut State, by: f64| {
                        [&mut room.q, &mut room.v, &mut room.a][part][*at] += by;
                    };
                    let was = [room.q[*at], room.v[*at], room.a[*at]];
                    moved(room, step);
                    let [_, torque] = shaft(individual, room);
                    [room.q[*at], room.v[*at], room.a[*at]] = was;
                    torque
                };
                by[part] = (asked(step) - asked(-step)) * (0.5 / step);
            }
        }
    }
}
