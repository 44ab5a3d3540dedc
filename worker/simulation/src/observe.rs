//! What is recorded of a revolution: gauge stress, rope tension, motion, torque.
use crate::drive::DriveState;
use crate::effect::Sampled;
use crate::integrator::State;
use crate::math::elementary::sin_cos;
use crate::model::chain::ChainState;
use crate::model::strand::Face;
use crate::model::{Individual, Instant, Machine, description::StressRecovery};
use crate::run::Observe;
use crate::system::System;

/// Stress at the four gauges \[Pa\] of a state whose joint loads are in the system.
///
/// Mode acceleration: exact static stress of the contact and anchor forces (influence lines) and of
/// the base acceleration, plus what the modes move beyond their own static answer,
/// `sum_k s_k (q_k - f_k / w_k^2)`. So a truncated set of modes costs no static accuracy.
///
/// Mode displacement: `sum_k s_k q_k` alone. The strain beside a pin is local, and six modes miss
/// much of it; it is here to compare with programs that recover stress so.
pub fn gauge_stress(system: &Individual<'_>, state: &State) -> [f64; 4] {
    match system.machine.description.head.recovery {
        StressRecovery::ModeAcceleration => mode_acceleration(system, state),
        StressRecovery::ModeDisplacement => mode_displacement(system.machine, state),
    }
}

fn mode_displacement(machine: &Machine, state: &State) -> [f64; 4] {
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

fn mode_acceleration(system: &Individual<'_>, state: &State) -> [f64; 4] {
    let machine = system.machine;
    let head = &machine.description.head;
    let layout = machine.layout;
    let modes = layout.modes;
    let mut stress = [0.0; 4];
    let mut modal_force = [0.0; crate::model::MAX_MODES];
    for chain in 0..machine.faces.len() {
        let load = HeadLoad::new(system, state, chain);
        load.add_stress(&mut stress);
        load.add_modal(&mut modal_force[..modes]);
    }

    // gravity acts like a base acceleration upwards, seen from the beam
    let beam = layout.beam();
    let (s, c) = sin_cos(state.q[beam]);
    let g = machine.description.gravity;
    let base = [g * s, g * c, state.a[beam]];
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

/// What one back rope does to the head.
struct HeadLoad<'a> {
    machine: &'a Machine,
    face: &'a Face,
    back: &'a ChainState,
    /// Force of the rope's end, in the beam frame \[N\].
    pull: [f64; 3],
    /// Its moment about the tangent of the arc and about the radius, where it turns the head [N m].
    moments: Option<[f64; 2]>,
}

impl<'a> HeadLoad<'a> {
    fn new(system: &'a Individual<'_>, state: &State, chain: usize) -> Self {
        let machine = system.machine;
        let (face, back) = (&machine.faces[chain], &system.scratch.chains[chain]);
        let beam = state.q[machine.layout.beam()];
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

    /// Adds its static stress: influence lines.
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
        let (sa, ca) = sin_cos(anchor);
        let inward = -(pull[0] * ca + pull[1] * sa);
        let along = pull[1] * ca - pull[0] * sa;
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

    /// Adds what it does to the modes.
    fn add_modal(&self, modal_force: &mut [f64]) {
        let Self { face, pull, .. } = self;
        let mut pressed = [0.0; crate::model::MAX_MODES];
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

/// Net torque that the reducer must give in the sense of rotation, counterweight included [N m].
pub fn crank_torque(machine: &Machine, drive: &DriveState, pin: &nalgebra::Vector2<f64>) -> f64 {
    let crank = &machine.description.crank;
    let (s, c) = sin_cos(drive.pin_angle);
    let rope = crank.radius * crank.sense * (pin.y * c - pin.x * s);
    // the counterweight hangs opposite the pin and falls while the rope is pulled
    let weight = crank.counterweight_moment
        * sin_cos(drive.pin_angle + crank.sense * crank.counterweight_phase).1;
    rope + crank.sense * weight
}

/// Curves of one revolution, one entry per sample reached.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curves {
    /// Stress at gauges 1 to 4 \[Pa\].
    pub gauge: [Vec<f64>; 4],
    /// Tension of the back rope at the crossbeam, of both where there are two \[N\].
    pub back_tension: Vec<f64>,
    /// Tension of the front rope at the suspension point, of both where there are two \[N\].
    pub front_tension: Vec<f64>,
    /// By how much the rope at +z pulls more than the one at -z, back and front \[N\]; empty where
    /// there is one.
    pub tension_difference: [Vec<f64>; 2],
    /// Beam angle \[rad\].
    pub beam: Vec<f64>,
    /// Height of the suspension point in W \[m\], its velocity and acceleration.
    pub suspension: [Vec<f64>; 3],
    /// Net crank torque [N m].
    pub torque: Vec<f64>,
    /// Modal coordinates, mode by mode.
    pub modal: Vec<Vec<f64>>,
    /// Shapes at every `shape_every`-th sample.
    pub shapes: Vec<Shape>,
}

/// The machine at one sample, in W.
#[derive(Clone, Debug, PartialEq)]
pub struct Shape {
    /// Index of the sample.
    pub sample: usize,
    /// Crank pin \[m\].
    pub pin: [f64; 2],
    /// Rope end of the rod \[m\].
    pub crossbeam: [f64; 2],
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Suspension point \[m\].
    pub suspension: [f64; 2],
    /// Cylinder centres of back and front rope from the free end on, of two ropes those at +z \[m\].
    pub centers: [Vec<[f64; 2]>; 2],
    /// Tension in the joint before each cylinder, of both ropes where there are two \[N\].
    pub tension: [Vec<f64>; 2],
    /// Contact force on each cylinder, of both where there are two \[N\].
    pub contact: [Vec<f64>; 2],
}

/// Records the gauges alone (for scoring), or everything.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    /// What was recorded.
    pub curves: Curves,
    gauges_only: bool,
    shape_every: usize,
    force: Vec<f64>,
}

impl Recorder {
    /// Records gauge stress alone: what a score needs.
    pub fn gauges_only() -> Self {
        Self {
            gauges_only: true,
            ..Self::default()
        }
    }

    /// Records everything, and the machine's shape at every `shape_every`-th sample.
    pub fn everything(shape_every: usize) -> Self {
        Self {
            shape_every,
            ..Self::default()
        }
    }
}

impl Observe for Recorder {
    fn sample(&mut self, index: usize, system: &mut System<Individual<'_>>, state: &State) {
        self.force.resize(state.q.len(), 0.0);
        // stress of the head asks for less than all loads; what readings and curves ask for is unknown
        let part = self.gauges_only && !system.equations.machine.hooks.has_readings();
        if part {
            let at = (state.t, &state.q, &state.v);
            system
                .equations
                .load_back_head(at.0, at.1, at.2, &mut self.force);
        } else {
            system.forces(state.t, &state.q, &state.v, &mut self.force);
        }
        let system = &mut system.equations;
        let drive = system.drive_state(state.t);
        let at = Instant {
            ropes: &system.ropes,
            drive: &drive,
            q: &state.q,
            v: &state.v,
        };
        let mut stress = gauge_stress(system, state);
        let machine = system.machine;
        let hooks = &machine.hooks;
        let recorded = system.drive.turn(state.t)[0] - hooks.index_offset();
        let sampled = Sampled {
            individual: system,
            beam: state.q[machine.layout.beam()],
            elapsed: recorded / std::f64::consts::TAU,
        };
        hooks.read(&sampled, &mut stress);
        for (curve, stress) in self.curves.gauge.iter_mut().zip(stress) {
            curve.push(stress);
        }
        if self.gauges_only {
            return;
        }
        let layout = machine.layout;
        let c = &mut self.curves;
        c.back_tension.push(system.base_tensions(0).sum());
        c.front_tension.push(system.base_tensions(1).sum());
        if layout.twins() {
            for (rope, curve) in c.tension_difference.iter_mut().enumerate() {
                let signed = [1.0, -1.0].into_iter().zip(system.base_tensions(rope));
                curve.push(signed.map(|(side, tension)| side * tension).sum());
            }
        }
        c.beam.push(state.q[layout.beam()]);
        let height = layout.suspension();
        for (curve, value) in
            c.suspension
                .iter_mut()
                .zip([state.q[height], state.v[height], state.a[height]])
        {
            curve.push(value);
        }
        let pin = machine.pin_force(&at, &state.a, &system.scratch);
        c.torque.push(crank_torque(machine, &drive, &pin));
        c.modal.resize(layout.modes, Vec::new());
        for (k, curve) in c.modal.iter_mut().enumerate() {
            curve.push(state.q[layout.mode(k)]);
        }
        if self.shape_every > 0 && index.is_multiple_of(self.shape_every) {
            c.shapes.push(shape(index, system, &drive, state));
        }
    }

    fn complete(&mut self, machine: &Machine, spacing: f64) {
        machine.hooks.read_series(spacing, &mut self.curves.gauge);
    }
}

fn shape(sample: usize, system: &Individual<'_>, drive: &DriveState, state: &State) -> Shape {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference;
    use crate::run::{RunSettings, simulate};

    /// Gauge curves and modal coordinates of the reference machine.
    fn curves(recovery: StressRecovery) -> (Machine, Curves) {
        let mut description = reference::description();
        description.head.recovery = recovery;
        let machine = Machine::new(description, 2).unwrap();
        let mut recorder = Recorder::everything(0);
        let settings = RunSettings {
            samples: 24,
            ..RunSettings::default()
        };
        simulate(&machine, &reference::law(), &settings, &mut recorder);
        (machine, recorder.curves)
    }

    #[test]
    fn mode_displacement_is_the_modes_and_nothing_else() {
        let (machine, modes) = curves(StressRecovery::ModeDisplacement);
        let (_, exact) = curves(StressRecovery::ModeAcceleration);
        assert_eq!(
            modes.modal, exact.modal,
            "recovery does not touch the motion"
        );
        assert_eq!(modes.beam.len(), 24);
        let per_unit = &machine.description.head.gauge_stress;
        for gauge in 0..4 {
            for (k, stress) in modes.gauge[gauge].iter().enumerate() {
                let sum: f64 = (0..2).map(|m| per_unit[m][gauge] * modes.modal[m][k]).sum();
                assert!((stress - sum).abs() <= 1e-12 * sum.abs(), "{stress} {sum}");
            }
            assert_ne!(modes.gauge[gauge], exact.gauge[gauge]);
        }
    }
}
