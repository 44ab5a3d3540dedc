//! Derivatives of the gauge stress with respect to the state, for a head under one rope in the plane.
//!
//! Stress is linear in the contact and anchor forces on the head: a contact point at arc angle `s` has the
//! weight `W_g(s) = N_g(s) + sum_m s_mg phi_m(s) / w_m^2`, its influence line minus the static response of
//! the modes that is included in the modal part. Hence `d stress = sum W_g df + f W_g' ds` over the contact
//! points, plus the corresponding terms of the rope's end, of the modes and of the beam. Derivatives of the
//! end's force are differences of one joint.
use crate::math::elementary::sin_cos;
use crate::model::chain::contact_point::{BORDER, FEW, LoadedPoint, for_each_loaded_point};
use crate::model::description::StressRecovery;
use crate::model::layout::{MAX_MODES, Motion};
use crate::model::{Machine, RopeMachine};
use crate::system::State;

type Each = [f64; 4];

/// Derivatives of the stress at the four gauges with respect to state and contact law.
#[derive(Clone, Debug, Default)]
pub(crate) struct Gradient {
    /// Nonzero stress derivatives: index of the coordinate, and the derivatives of the gauge stress with
    /// respect to that coordinate and to its rate.
    pub(crate) entries: Vec<(usize, [Each; 2])>,
    /// Derivative of the gauge stress with respect to the beam's angular acceleration.
    pub(crate) by_acceleration: Each,
    /// Derivatives of the gauge stress with respect to stiffness and damping of the contact law.
    pub(crate) by_contact: [Each; 2],
    /// Derivatives with respect to the force of the rope's end along x and y of the beam frame [Pa/N].
    pub(crate) by_pull: [Each; 2],
    /// Index in `entries` of the stress derivatives with respect to each coordinate; `None` if they are zero.
    places: Vec<Option<usize>>,
}

/// Finite-difference steps for the force of the joint at the rope's fixed end: of a coordinate, and of a rate
/// (in which the force is linear).
const STEPS: [f64; 2] = [1e-7, 1e-4];

fn add(to: &mut Each, weight: f64, x: &Each) {
    for (to, x) in to.iter_mut().zip(x) {
        *to += weight * x;
    }
}

/// Returns the gauge stress per unit of static force on mode `m`, which the mode acceleration method
/// subtracts.
fn modal(machine: &Machine, m: usize) -> Each {
    let head = &machine.description.head;
    let w = head.frequencies[m];
    head.gauge_stress[m].map(|stress| stress / (w * w))
}

impl Gradient {
    /// Allocates the stress derivatives for a machine with `n` coordinates.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            entries: Vec::with_capacity(n),
            places: Vec::with_capacity(n),
            ..Self::default()
        }
    }

    /// Returns whether analytic stress derivatives are available for a machine: motion in the plane, one back
    /// rope, no stages of the measuring chain that use loads, mode-acceleration recovery.
    pub(crate) fn available_for(machine: &Machine) -> bool {
        machine.layout.motion == Motion::Plane
            && machine.faces.len() == 1
            && !machine.extensions.readings_need_loads()
            && machine.description.head.recovery == StressRecovery::ModeAcceleration
    }

    /// Computes the stress derivatives at a state for which the individual holds the loads on the back head;
    /// `room` is a state used as workspace.
    pub(crate) fn fill(
        &mut self,
        individual: &mut RopeMachine<'_>,
        state: &State,
        room: &mut State,
    ) {
        let machine = individual.machine;
        let layout = machine.layout;
        let beam = layout.beam();
        self.entries.clear();
        self.places.clear();
        self.places.resize(state.q.len(), None);
        self.by_contact = [[0.0; 4]; 2];
        self.by_rigid(machine, state);
        if layout.modes < FEW {
            self.by_points::<FEW>(individual, state);
        } else {
            self.by_points::<BORDER>(individual, state);
        }
        self.by_pull = by_pull(machine);
        let last = machine.chains[0].range().end;
        room.q.copy_from_slice(&state.q);
        room.v.copy_from_slice(&state.v);
        room.t = state.t;
        for k in (last - 3..last).chain(beam..=beam + layout.modes) {
            self.by_end(individual, room, k);
        }
    }

    fn entry(&mut self, k: usize) -> &mut [Each; 2] {
        let at = *self.places[k].get_or_insert_with(|| {
            self.entries.push((k, [[0.0; 4]; 2]));
            self.entries.len() - 1
        });
        &mut self.entries[at].1
    }

    /// Adds the stress derivatives due to the head's weight and acceleration, and due to its modes.
    fn by_rigid(&mut self, machine: &Machine, state: &State) {
        let head = &machine.description.head;
        let layout = machine.layout;
        let mut base = [
            head.weight_stress[0],
            head.weight_stress[1],
            head.turning_stress,
        ];
        for m in 0..layout.modes {
            for (base, coupling) in base.iter_mut().zip(head.participation[m]) {
                add(base, coupling, &modal(machine, m));
            }
            let own = self.entry(layout.mode(m));
            add(&mut own[0], 1.0, &head.gauge_stress[m]);
        }
        let beam = layout.beam();
        let (s, c) = sin_cos(state.q[beam]);
        let g = machine.description.gravity;
        let own = self.entry(beam);
        add(&mut own[0], g * c, &base[0]);
        add(&mut own[0], -g * s, &base[1]);
        self.by_acceleration = base[2];
    }

    fn by_points<const B: usize>(&mut self, individual: &RopeMachine<'_>, state: &State) {
        let machine = individual.machine;
        let (face, chain) = (&machine.faces[0], &machine.chains[0]);
        let modes = machine.layout.modes;
        let beam = machine.layout.beam();
        let deflection = &individual.scratch.deflection;
        let surface = machine.surface(0, &state.q, &state.v, deflection);
        let law = (&surface, &individual.ropes.contact);
        for_each_loaded_point(
            law,
            &individual.scratch.chains[0],
            |j, point: &LoadedPoint<B>| {
                let (mut value, mut slope) = ([0.0; 4], [0.0; 4]);
                let place = face.normal_influence.place(point.angle);
                face.normal_influence.slopes(&place, &mut value, &mut slope);
                let (mut shape, mut tilt) = ([0.0; MAX_MODES], [0.0; MAX_MODES]);
                let place = face.radial.place(point.angle);
                face.radial
                    .slopes(&place, &mut shape[..modes], &mut tilt[..modes]);
                for m in 0..modes {
                    let unit = modal(machine, m);
                    add(&mut value, shape[m], &unit);
                    add(&mut slope, tilt[m], &unit);
                }
                for (by, of) in self.by_contact.iter_mut().zip(point.by_law) {
                    add(by, of, &value);
                }
                let first = (chain.first + j) * 3;
                for k in 0..3 {
                    let own = self.entry(first + k);
                    add(&mut own[0], point.force_by[0][k], &value);
                    add(&mut own[0], point.force * point.angle_by[k], &slope);
                    add(&mut own[1], point.force_by[1][k], &value);
                }
                for k in 0..=modes {
                    let own = self.entry(beam + k);
                    add(&mut own[0], point.force_by_border[0][k], &value);
                    add(&mut own[1], point.force_by_border[1][k], &value);
                }
                let own = self.entry(beam);
                add(&mut own[0], point.force * point.angle_by_beam, &slope);
            },
        );
    }

    /// Adds the stress derivatives through the force of the rope's end with respect to coordinate `k` of
    /// `state` and its rate, by finite differences.
    fn by_end(&mut self, individual: &mut RopeMachine<'_>, state: &mut State, k: usize) {
        let by_pull = self.by_pull;
        let was = [state.q[k], state.v[k]];
        for (part, step) in STEPS.into_iter().enumerate() {
            let mut by = [0.0; 2];
            for step in [step, -step] {
                [&mut state.q, &mut state.v][part][k] = was[part] + step;
                let at = state.motion();
                let pull = individual.anchor_pull(at);
                for (by, pull) in by.iter_mut().zip(pull) {
                    *by += pull * (0.5 / step);
                }
            }
            [state.q[k], state.v[k]] = was;
            let own = &mut self.entry(k)[part];
            add(own, by[0], &by_pull[0]);
            add(own, by[1], &by_pull[1]);
        }
    }
}

/// Returns the gauge stress per unit of force of the rope's end along x and y of the beam frame.
fn by_pull(machine: &Machine) -> [Each; 2] {
    let face = &machine.faces[0];
    let anchor = machine.description.back_arc.anchor;
    let (s, c) = sin_cos(anchor);
    let (mut inward, mut along) = ([0.0; 4], [0.0; 4]);
    let place = face.normal_influence.place(anchor);
    face.normal_influence.values(&place, &mut inward);
    let place = face.tangential_influence.place(anchor);
    face.tangential_influence.values(&place, &mut along);
    let mut by = [[0.0; 4]; 2];
    for (by, (normal, tangential)) in by.iter_mut().zip([(-c, -s), (-s, c)]) {
        add(by, normal, &inward);
        add(by, tangential, &along);
    }
    for (m, shape) in face.anchor.iter().enumerate() {
        for (by, moves) in by.iter_mut().zip(shape.moves) {
            add(by, -moves, &modal(machine, m));
        }
    }
    by
}
