//! Gauge stress of a state, recovered from modes and forces.
use super::curves::HeadLoadCurves;
use crate::math::elementary::sin_cos;
use crate::model::chain::ChainState;
use crate::model::description::StressRecovery;
use crate::model::layout::MAX_MODES;
use crate::model::parallel_ropes::HeadResponse;
use crate::model::{BackHeadLoads, Machine};
use crate::system::StateRef;

/// Returns the stress at the four gauges \[Pa\] of a state under accelerations `a`.
///
/// Mode acceleration: exact static stress of the contact and anchor forces (influence lines) and of the base
/// acceleration, plus the modal response beyond its static part, `sum_k s_k (q_k - f_k / w_k^2)`. A truncated
/// set of modes thus keeps the full static accuracy.
///
/// Mode displacement: `sum_k s_k q_k` alone. The strain near a pin is local, and six modes miss much of it;
/// this option serves for comparison with programs that recover stress in this way.
pub fn gauge_stress(loads: &BackHeadLoads<'_, '_>, a: &[f64]) -> [f64; 4] {
    let machine = loads.individual().machine;
    match machine.description.head.recovery {
        StressRecovery::ModeAcceleration => mode_acceleration(loads, a),
        StressRecovery::ModeDisplacement => mode_displacement(machine, loads.state()),
    }
}

/// Returns the acceleration of the beam frame that the head's inertia and weight respond to: along x and y of the
/// frame, gravity as an acceleration upwards [m/s2], and about the pivot [rad/s2].
fn base_acceleration(machine: &Machine, state: StateRef<'_>, a: &[f64]) -> [f64; 3] {
    let beam = machine.layout.beam();
    let (s, c) = sin_cos(state.q[beam]);
    let g = machine.description.gravity;
    [g * s, g * c, a[beam]]
}

/// Adds the loads of the back head at a state under accelerations `a` to its curves: as in mode acceleration, the modes
/// count by what they exceed their static response.
pub(super) fn record_head_loads(
    curves: &mut HeadLoadCurves,
    loads: &BackHeadLoads<'_, '_>,
    a: &[f64],
) {
    let (machine, state) = (loads.individual().machine, loads.state());
    let (head, layout) = (&machine.description.head, machine.layout);
    let breaks = &head.load_breaks;
    let intervals = breaks.len().saturating_sub(1);
    curves.normal.resize(intervals, Vec::new());
    for curve in &mut curves.normal {
        curve.push(0.0);
    }
    let sample = curves.acceleration[0].len();
    for curve in &mut curves.anchor {
        curve.push(0.0);
    }
    let mut modal_force = [0.0; MAX_MODES];
    for chain in 0..machine.faces.len() {
        let load = HeadLoad::new(loads, chain);
        load.add_modal(&mut modal_force[..layout.modes]);
        for (angle, force) in load.back.points.forces() {
            let inside = breaks.partition_point(|from| *from <= angle);
            let interval = inside.saturating_sub(1).min(intervals.saturating_sub(1));
            if let Some(curve) = curves.normal.get_mut(interval) {
                curve[sample] += force;
            }
        }
        for (curve, force) in curves.anchor.iter_mut().zip(load.at_anchor()) {
            curve[sample] += force;
        }
    }
    let base = base_acceleration(machine, state, a);
    for (curve, acceleration) in curves.acceleration.iter_mut().zip(base) {
        curve.push(acceleration);
    }
    curves.beyond.resize(layout.modes, Vec::new());
    for (m, curve) in curves.beyond.iter_mut().enumerate() {
        let inertia = base.iter().zip(&head.participation[m]);
        let inertia: f64 = inertia
            .map(|(acceleration, share)| acceleration * share)
            .sum();
        let w = head.frequencies[m];
        curve.push(state.q[layout.mode(m)] - (modal_force[m] - inertia) / (w * w));
    }
}

fn mode_displacement(machine: &Machine, state: StateRef<'_>) -> [f64; 4] {
    let mut stress = [0.0; 4];
    for (k, row) in machine.description.head.gauge_stress[..machine.layout.modes]
        .iter()
        .enumerate()
    {
        for (stress, per_unit) in stress.iter_mut().zip(row) {
            *stress += state.q[machine.layout.mode(k)] * per_unit;
        }
    }
    stress
}

fn mode_acceleration(loads: &BackHeadLoads<'_, '_>, a: &[f64]) -> [f64; 4] {
    let (machine, state) = (loads.individual().machine, loads.state());
    let head = &machine.description.head;
    let layout = machine.layout;
    let modes = layout.modes;
    let mut stress = [0.0; 4];
    let mut modal_force = [0.0; MAX_MODES];
    for chain in 0..machine.faces.len() {
        let load = HeadLoad::new(loads, chain);
        load.add_stress(&mut stress);
        load.add_modal(&mut modal_force[..modes]);
    }

    let base = base_acceleration(machine, state, a);
    let base_stress = [
        &head.weight_stress[0],
        &head.weight_stress[1],
        &head.turning_stress,
    ];
    for (k, acceleration) in base.iter().enumerate() {
        for (stress, unit) in stress.iter_mut().zip(base_stress[k]) {
            *stress += acceleration * unit;
        }
        for (m, modal) in modal_force[..modes].iter_mut().enumerate() {
            *modal -= acceleration * head.participation[m][k];
        }
    }
    for m in 0..modes {
        let w = head.frequencies[m];
        let beyond = state.q[layout.mode(m)] - modal_force[m] / (w * w);
        for (gauge, stress) in stress.iter_mut().enumerate() {
            *stress += beyond * head.gauge_stress[m][gauge];
        }
    }
    stress
}

/// Loads of one back rope on the head.
struct HeadLoad<'a> {
    machine: &'a Machine,
    face: &'a HeadResponse,
    back: &'a ChainState,
    /// Force of the rope's end on the head, in the beam frame \[N\].
    pull: [f64; 3],
    /// Moment of the rope's end about the tangent of the arc and about the radius [N m]; `None` for a single
    /// rope, whose end does not rotate with the head.
    moments: Option<[f64; 2]>,
}

impl<'a> HeadLoad<'a> {
    fn new(loads: &BackHeadLoads<'a, 'a>, chain: usize) -> Self {
        let individual = loads.individual();
        let machine = individual.machine;
        let (face, back) = (&machine.faces[chain], &individual.scratch.chains[chain]);
        let beam = loads.state().q[machine.layout.beam()];
        let (s, c) = sin_cos(beam);
        let load = &back.joints[machine.layout.back];
        let force = load.force;
        let (sa, ca) = sin_cos(machine.description.back_arc.anchor + beam);
        let torque = load.torque_i;
        let moments = [torque.y * ca - torque.x * sa, torque.x * ca + torque.y * sa];
        Self {
            machine,
            face,
            back,
            pull: [
                c * force.x + s * force.y,
                c * force.y - s * force.x,
                force.z,
            ],
            moments: face.beside.map(|_| moments),
        }
    }

    /// Returns the force of the rope's end on the head, inwards and towards increasing psi \[N\].
    fn at_anchor(&self) -> [f64; 2] {
        let pull = self.pull;
        let (sa, ca) = sin_cos(self.machine.description.back_arc.anchor);
        [-(pull[0] * ca + pull[1] * sa), pull[1] * ca - pull[0] * sa]
    }

    /// Adds the static gauge stress caused by the rope's loads on the head, from influence lines.
    fn add_stress(&self, stress: &mut [f64; 4]) {
        let Self { face, pull, .. } = self;
        for (angle, force) in self.back.points.forces() {
            let place = face.normal_influence.place(angle);
            let mut unit = [0.0; 4];
            face.normal_influence.values(&place, &mut unit);
            for (stress, unit) in stress.iter_mut().zip(unit) {
                *stress += force * unit;
            }
        }
        let anchor = self.machine.description.back_arc.anchor;
        let [inward, along] = self.at_anchor();
        let place = face.normal_influence.place(anchor);
        let place_t = face.tangential_influence.place(anchor);
        for (gauge, stress) in stress.iter_mut().enumerate() {
            *stress += inward * face.normal_influence.jet(&place, gauge).value
                + along * face.tangential_influence.jet(&place_t, gauge).value;
        }
        if let (Some(beside), Some(moments)) = (&face.beside, self.moments) {
            for (gauge, stress) in stress.iter_mut().enumerate() {
                *stress += pull[2] * beside.lateral[gauge];
                for (moment, unit) in moments.iter().zip(&beside.turning) {
                    *stress += moment * unit[gauge];
                }
            }
        }
    }

    /// Adds the generalised forces of the loads on the modes.
    fn add_modal(&self, modal_force: &mut [f64]) {
        let Self { face, pull, .. } = self;
        let mut pressed = [0.0; MAX_MODES];
        let pressed = &mut pressed[..modal_force.len()];
        // what the arc's contact does to the modes is at hand
        self.back.pressure.gather(&face.radial, pressed);
        for (modal, pressed) in modal_force.iter_mut().zip(pressed) {
            *modal -= *pressed;
        }
        for (modal, shape) in modal_force.iter_mut().zip(&face.anchor) {
            *modal += pull[0] * shape.moves[0] + pull[1] * shape.moves[1];
            if let Some(moments) = self.moments {
                *modal += pull[2] * shape.moves[2]
                    + moments[0] * shape.turns[0]
                    + moments[1] * shape.turns[1];
            }
        }
    }
}
