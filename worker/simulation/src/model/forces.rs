//! Generalised forces, inertia forces and energies of a machine, and the powers for its energy balance.
//!
//! The equations of motion are `M(q) a = Q(q, v, t)`; this module computes `Q` and `M a`.
use crate::element::bushing::{LinkLoad, Marker, PRELOAD_INDEX};
use crate::element::impact::DerivativeVariable;
use crate::linear::MatrixEntry;
use crate::math::elementary::sin_cos;
use crate::math::spline::sum::WeightedSplines;
use crate::model::chain::parts::Joints;
use crate::model::chain::state::ChainState;
use crate::model::chain::unit_loads::UnitLoads;
use crate::model::contact::{Deflection, Surface};
use crate::model::extension::{Extensions, MemoryDerivatives};
use crate::model::force_buffers::ForceBuffers;
use crate::model::machine::Machine;
use crate::model::machine_state::MachineState;
use crate::model::parallel_ropes::BACK;
use crate::model::ropes::Ropes;
use crate::system::Powers;
use nalgebra::{Vector2, Vector3};

type V2 = Vector2<f64>;
type V3 = Vector3<f64>;

/// Selection of terms of the generalised forces. A difference of forces between two machines needs only the
/// terms in which they differ.
#[expect(
    clippy::struct_excessive_bools,
    reason = "a set of terms, each there or not"
)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Terms {
    /// Whether to include weights of and loads on the rigid bodies, elastic and damping forces of the head's
    /// modes, and forces added by effects.
    pub(crate) rigid: bool,
    /// Whether to include the weights of the cylinders and their velocity-dependent inertia terms.
    pub(crate) weights: bool,
    /// Whether to include the joints at both ends of the ropes; the joints between cylinders are not
    /// affected.
    pub(crate) ends: bool,
    /// Whether to include all rope joints together with the axial laws that effects add to them.
    pub(crate) joints: bool,
    /// Whether to include the axial laws that effects add to the rope joints; the joints' own forces are not
    /// affected.
    pub(crate) pulls: bool,
    /// Whether to include the rope's contact with the back head (first) and with the front head (second).
    pub(crate) contact: [bool; 2],
}

impl Terms {
    pub(crate) const ALL: Self = Self {
        rigid: true,
        weights: true,
        ends: true,
        joints: true,
        pulls: false,
        contact: [true; 2],
    };
    pub(crate) const NONE: Self = Self {
        rigid: false,
        weights: false,
        ends: false,
        joints: false,
        pulls: false,
        contact: [false; 2],
    };
}

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Computes the poses of all cylinders and the deflection of the back head's arc into `scratch`.
    pub(crate) fn pose(&self, q: &[f64], v: &[f64], scratch: &mut ForceBuffers) {
        self.deflect(q, v, scratch);
        for (chain, state) in self.chains.iter().zip(&mut scratch.chains) {
            chain.pose(q, v, state);
        }
    }

    /// Computes the deflection of the back head's arc into `scratch`.
    fn deflect(&self, q: &[f64], v: &[f64], scratch: &mut ForceBuffers) {
        let modal = self.layout.beam() + 1..;
        let (q, v) = (&q[modal.clone()], &v[modal]);
        for (face, deflection) in self.faces.iter().zip(&mut scratch.deflection) {
            deflection.assemble(&face.radial, q, v);
        }
    }

    /// Computes the generalised forces `Q(q, v, t)` into `force`, and leaves the loads of joints and contacts
    /// in `scratch`.
    pub(super) fn forces(
        &self,
        at: &MachineState<'_>,
        scratch: &mut ForceBuffers,
        force: &mut [f64],
    ) {
        for (chain, state) in self.chains.iter().zip(&mut scratch.chains) {
            chain.pose(at.q, at.v, state);
        }
        self.posed_forces(at, Terms::ALL, scratch, force);
    }

    /// Computes the selected terms of `Q(q, v, t)` into `force`, using the cylinder poses already in
    /// `scratch`.
    pub(super) fn posed_forces(
        &self,
        at: &MachineState<'_>,
        terms: Terms,
        scratch: &mut ForceBuffers,
        force: &mut [f64],
    ) {
        force.fill(0.0);
        if terms.contact[BACK] {
            self.deflect(at.q, at.v, scratch);
        }
        if terms.rigid {
            self.weights(at, force);
        }
        for (k, chain) in self.chains.iter().enumerate() {
            let state = &mut scratch.chains[k];
            if terms.weights {
                chain.add_weights(&self.gravity(), state, force);
            }
            if terms.ends || terms.joints {
                let joints = self.joints(k, at);
                if terms.joints {
                    chain.add_joints(&joints, state, force);
                } else {
                    chain.add_ends(&joints, state, force);
                }
                let loads = &scratch.chains[k].joints;
                let end = joints.head.map(|head| head.marker);
                let loads = [loads.first(), loads.last()];
                self.end_forces(k, at, (end.as_ref(), loads), |i, value| force[i] += value);
            }
            if terms.pulls {
                let state = &scratch.chains[k];
                chain.add_pulls(&self.joints(k, at), (state, &state.memory), force);
            }
            if terms.contact[self.strands[k].rope] {
                let surface = self.surface(k, at.q, at.v, &scratch.deflection);
                let (blocks, border) = force.split_at_mut(self.layout.beam());
                chain.add_contact(
                    &surface,
                    &at.ropes.contact,
                    &mut scratch.chains[k],
                    blocks,
                    border,
                );
            }
        }
        if terms.rigid {
            self.extensions.add_forces(at, force);
        }
    }

    /// Computes into `force` the generalised forces of extensions that belong to an effect but not to this
    /// machine, using the cylinder poses in `scratch`; their axial laws have no memory.
    pub(super) fn forces_of(
        &self,
        extensions: &Extensions,
        at: &MachineState<'_>,
        (scratch, units): (&ForceBuffers, &[UnitLoads]),
        force: &mut [f64],
    ) {
        force.fill(0.0);
        extensions.add_forces(at, force);
        for (k, chain) in self.chains.iter().enumerate() {
            let axial = self.axial(extensions, k, at);
            let uniform = axial.and_then(|laws| laws.uniform());
            if let (Some(pull), Some(units)) = (uniform, units.get(k)) {
                units.add_inner((PRELOAD_INDEX, pull), &mut force[chain.range()], |x| x);
            } else if axial.is_some() {
                let joints = Joints {
                    axial,
                    ..self.joints(k, at)
                };
                chain.add_pulls(&joints, (&scratch.chains[k], &[]), force);
            }
        }
    }

    /// Computes into `force` the derivative of the contact forces on the selected heads with respect to
    /// contact stiffness, contact damping or penetration, as `by` states, using the contact points in
    /// `scratch` that are in compression.
    pub(super) fn contact_by(
        &self,
        at: &MachineState<'_>,
        (by, heads): (DerivativeVariable, [bool; 2]),
        scratch: &mut ForceBuffers,
        force: &mut [f64],
    ) {
        force.fill(0.0);
        let touching = |k: &usize| heads[self.strands[*k].rope];
        for k in (0..self.chains.len()).filter(touching) {
            let chain = &self.chains[k];
            let surface = self.surface(k, at.q, at.v, &scratch.deflection);
            let (blocks, border) = force.split_at_mut(self.layout.beam());
            let state = &mut scratch.chains[k];
            let law = &at.ropes.contact;
            state.points.replace_forces_by_derivatives(law, by);
            chain.add_evaluated_contact(&surface, state, blocks, border);
        }
    }

    /// Computes only the loads on the back head (contact and anchor forces of the back ropes) into `scratch`,
    /// with the same result as [`Self::forces`].
    pub(crate) fn back_head_loads(
        &self,
        at: &MachineState<'_>,
        scratch: &mut ForceBuffers,
        force: &mut [f64],
    ) {
        force.fill(0.0);
        self.deflect(at.q, at.v, scratch);
        for (k, chain) in self.chains[..self.faces.len()].iter().enumerate() {
            let state = &mut scratch.chains[k];
            chain.pose(at.q, at.v, state);
            chain.load_head(&self.joints(k, at), state);
            let surface = self.surface(k, at.q, at.v, &scratch.deflection);
            let (blocks, border) = force.split_at_mut(self.layout.beam());
            chain.add_contact(&surface, &at.ropes.contact, state, blocks, border);
        }
    }

    /// Returns the acceleration of gravity as a vector in the world frame W [m/s2].
    pub(crate) fn gravity(&self) -> V3 {
        V3::new(0.0, -self.description.gravity, 0.0)
    }

    /// Adds to `force` the weights of the rigid bodies and the loads on them, and the elastic, damping and
    /// weight forces on the head's modes.
    fn weights(&self, at: &MachineState<'_>, force: &mut [f64]) {
        let &MachineState { q, v, drive, .. } = at;
        let d = &self.description;
        let g = d.gravity;
        let rod = self.layout.rod();
        let (s, c) = sin_cos(q[rod]);
        let pin = drive.pin[2];
        // the pin's acceleration acts on the rod like a field
        force[rod] = -d.rod.mass * d.rod.center_of_mass * ((pin.y + g) * c - pin.x * s);
        force[self.layout.suspension()] = -d.suspension_mass * g - drive.load;

        let beam = self.layout.beam();
        let (s, c) = sin_cos(q[beam]);
        force[beam] = -d.beam_moment((s, c));
        for k in 0..self.layout.modes {
            let i = self.layout.mode(k);
            let [px, py, _] = d.head.participation[k];
            let w = d.head.frequencies[k];
            force[i] =
                -g * (px * s + py * c) - w * w * q[i] - 2.0 * d.head.damping_ratio * w * v[i];
            force[beam] += q[i] * g * (py * s - px * c);
        }
    }

    /// Adds the forces that the end joints of a chain exert on the rod or suspension, on the beam and on the
    /// modes of the back head, through `add` with the index of a coordinate and its force. `base` and `head`
    /// are the loads of the two joints, `end` is the marker on the head.
    fn end_forces(
        &self,
        chain: usize,
        at: &MachineState<'_>,
        (end, [base, head]): (Option<&Marker>, [Option<&LinkLoad>; 2]),
        mut add: impl FnMut(usize, f64),
    ) {
        if let Some(load) = base {
            if self.strands[chain].rope == BACK {
                add(self.layout.rod(), load.torque_j.z);
            } else {
                add(self.layout.suspension(), -load.force.y);
            }
        }
        let (Some(load), Some(i)) = (head, end) else {
            return;
        };
        let beam = self.layout.beam();
        let on_beam = load.torque_i.z + i.p.x * load.force.y - i.p.y * load.force.x;
        add(beam, on_beam);
        let Some(face) = self.faces.get(chain) else {
            return;
        };
        let (s, c) = sin_cos(at.q[beam]);
        for (k, shape) in face.anchor.iter().enumerate() {
            let [x, y, _] = shape.moves;
            let pressed = load.force.x * (c * x - s * y) + load.force.y * (s * x + c * y);
            add(self.layout.mode(k), pressed);
        }
        if let Some(turn) = self.end_rotation(face, self.arc(chain).anchor, at) {
            let moments = turn.axes().map(|axis| load.torque_i.dot(&axis));
            for (k, shape) in face.anchor.iter().enumerate() {
                let turned = shape.turns[0] * moments[0] + shape.turns[1] * moments[1];
                add(self.layout.mode(k), load.force.z * shape.moves[2] + turned);
            }
        }
    }

    /// Computes the loads of all rope joints per unit of each of their coefficients, at the cylinder poses in
    /// `scratch`, for motion in the plane.
    pub(super) fn unit_loads(
        &self,
        at: &MachineState<'_>,
        scratch: &ForceBuffers,
        units: &mut [UnitLoads],
    ) {
        for (k, units) in units.iter_mut().enumerate() {
            units.fill(&self.chains[k], &self.joints(k, at), &scratch.chains[k]);
        }
    }

    /// Computes the derivatives that concern the memory of the axial laws, one list per chain, from the loads of the
    /// joints per unit of each coefficient; see [`Chain::memory_derivatives`].
    pub(super) fn memory_derivatives(
        &self,
        at: &MachineState<'_>,
        (scratch, units): (&ForceBuffers, &[UnitLoads]),
        out: &mut [Vec<MemoryDerivatives>],
    ) {
        for (k, (units, out)) in units.iter().zip(out).enumerate() {
            let state = (&scratch.chains[k], units);
            self.chains[k].memory_derivatives(&self.joints(k, at), state, out);
        }
    }

    /// Adds the generalised forces of all rope joints in the plane under the laws of `ropes`, in which one
    /// coefficient is 1 and all others are zero, times `factor`. `inner` is the index of that coefficient in
    /// the law of the joints between cylinders and its value there; `None` if they do not depend on it.
    /// `entry` selects a number of an element of `force`.
    pub(super) fn add_unit_forces<T>(
        &self,
        at: &MachineState<'_>,
        (ropes, inner): (&Ropes, Option<(usize, f64)>),
        (units, factor): (&[UnitLoads], f64),
        force: &mut [T],
        entry: impl Fn(&mut T) -> &mut f64,
    ) {
        for (k, (chain, units)) in self.chains.iter().zip(units).enumerate() {
            if let Some((coefficient, value)) = inner {
                let scaled = (coefficient, factor * value);
                units.add_inner(scaled, &mut force[chain.range()], &entry);
            }
            let loads = units.end_loads([&ropes.base, &ropes.anchor]);
            let mut add = |i: usize, value: f64| *entry(&mut force[i]) += factor * value;
            for (end, load) in loads.iter().enumerate() {
                if let Some(load) = load {
                    chain.add_plane_end(end, load, &mut add);
                }
            }
            let marker = units.ends[1].as_ref().map(|[i, _]| i);
            self.end_forces(k, at, (marker, loads.each_ref().map(Option::as_ref)), add);
        }
    }

    /// Returns the head surface that a chain touches at an instant, with the head deflection computed by
    /// [`Self::pose`].
    pub(crate) fn surface<'a>(
        &'a self,
        chain: usize,
        q: &'a [f64],
        v: &'a [f64],
        deflection: &'a [WeightedSplines],
    ) -> Surface<'a> {
        let beam = self.layout.beam();
        let face = self.faces.get(chain);
        let bend = face
            .zip(deflection.get(chain))
            .map(|(face, sum)| Deflection {
                shapes: &face.radial,
                sum,
                modal_rate: &v[beam + 1..],
            });
        let bend = bend.filter(|_| self.layout.modes > 0);
        let mut surface = Surface::new(self.arc(chain), [q[beam], v[beam]], bend);
        if face.is_some() {
            surface.profile = self.extensions.profile();
            surface.reach += self.extensions.extra_reach();
        }
        surface
    }

    /// Subtracts the inertia forces: `out -= M(q) a`.
    pub(super) fn subtract_inertia<T: MatrixEntry>(&self, q: &[f64], a: &[T], out: &mut [T]) {
        let d = &self.description;
        let rod = self.layout.rod();
        out[rod] -= a[rod] * self.rod_inertia();
        let at = self.layout.suspension();
        out[at] -= a[at] * d.suspension_mass;
        let beam = self.layout.beam();
        out[beam] -= a[beam] * d.beam_inertia;
        for k in 0..self.layout.modes {
            let i = self.layout.mode(k);
            let coupling = d.head.participation[k][2];
            out[i] -= a[i] + a[beam] * coupling;
            out[beam] -= a[i] * coupling;
        }
        for chain in &self.chains {
            chain.subtract_inertia(q, a, out);
        }
    }

    /// Returns the moment of inertia of the rod about the crank pin [kg m2].
    pub(crate) fn rod_inertia(&self) -> f64 {
        let rod = &self.description.rod;
        rod.inertia + rod.mass * rod.center_of_mass * rod.center_of_mass
    }

    /// Returns the force that the crank pin exerts on the rod \[N\], from the accelerations and the joint
    /// loads in `scratch`.
    pub(crate) fn pin_force(&self, at: &MachineState<'_>, a: &[f64], scratch: &ForceBuffers) -> V2 {
        let back = &scratch.chains[..self.faces.len()];
        let pull = back.iter().map(|chain| chain.joints[0].force);
        self.pin_force_under(at, a, pull.fold(V3::zeros(), |sum, force| sum + force))
    }

    /// Returns the force that the crank pin exerts on the rod \[N\], given the force `rope` that the back
    /// ropes' base joints exert on their first cylinders.
    pub(super) fn pin_force_under(&self, at: &MachineState<'_>, a: &[f64], rope: V3) -> V2 {
        let rod = &self.description.rod;
        let i = self.layout.rod();
        let (s, c) = sin_cos(at.q[i]);
        let center = at.drive.pin[2] + V2::new(-s, c) * (rod.center_of_mass * a[i])
            - V2::new(c, s) * (rod.center_of_mass * at.v[i] * at.v[i]);
        // the joints pull the rod with minus the force on the first cylinders
        V2::new(
            rod.mass * center.x + rope.x,
            rod.mass * (center.y + self.description.gravity) + rope.y,
        )
    }

    /// Returns input, output and dissipated power at an instant whose loads are in `scratch`.
    pub(super) fn powers(
        &self,
        at: &MachineState<'_>,
        a: &[f64],
        scratch: &ForceBuffers,
    ) -> Powers {
        let v = at.v;
        let pin = self.pin_force(at, a, scratch);
        let mut dissipated: f64 = scratch.chains.iter().map(ChainState::losses).sum();
        let head = &self.description.head;
        for k in 0..self.layout.modes {
            let rate = v[self.layout.mode(k)];
            dissipated += 2.0 * head.damping_ratio * head.frequencies[k] * rate * rate;
        }
        dissipated += self.extensions.lost(at);
        Powers {
            input: pin.dot(&at.drive.pin[1]),
            output: at.drive.load * v[self.layout.suspension()],
            dissipated,
        }
    }

    /// Evaluates the contact points between ropes and heads at the cylinder poses computed by [`Self::pose`].
    pub(crate) fn touch(&self, at: &MachineState<'_>, scratch: &mut ForceBuffers) {
        for (k, chain) in self.chains.iter().enumerate() {
            let surface = self.surface(k, at.q, at.v, &scratch.deflection);
            chain.evaluate_contact(&surface, &at.ropes.contact, &mut scratch.chains[k]);
        }
    }

    /// Returns kinetic plus potential energy \[J\], without the potential of the load; `scratch` must hold
    /// poses and contact points.
    pub(super) fn energy(&self, at: &MachineState<'_>, scratch: &ForceBuffers) -> f64 {
        self.potential(at, scratch) + self.kinetic(at)
    }

    /// Returns the elastic and gravitational potential energy of the machine \[J\].
    pub(super) fn potential(&self, at: &MachineState<'_>, scratch: &ForceBuffers) -> f64 {
        let &MachineState { q, drive, .. } = at;
        let d = &self.description;
        let g = d.gravity;
        let (rod, beam) = (self.layout.rod(), self.layout.beam());
        let mut sum = d.rod.mass * g * (drive.pin[0].y + d.rod.center_of_mass * sin_cos(q[rod]).0)
            + d.suspension_mass * g * q[self.layout.suspension()];
        let (s, c) = sin_cos(q[beam]);
        sum += d.beam_potential((s, c));
        for k in 0..self.layout.modes {
            let x = q[self.layout.mode(k)];
            let [px, py, _] = d.head.participation[k];
            let w = d.head.frequencies[k];
            sum += 0.5 * w * w * x * x + g * x * (px * s + py * c);
        }
        for (k, chain) in self.chains.iter().enumerate() {
            chain.add_potential(
                &mut sum,
                &self.gravity(),
                &self.joints(k, at),
                Some(&at.ropes.contact),
                &scratch.chains[k],
            );
        }
        sum + self.extensions.energy(at)
    }

    /// Returns the static potential of the effects' forces minus the energy that they store \[J\].
    pub(crate) fn potential_beyond_energy(
        &self,
        at: &MachineState<'_>,
        scratch: &ForceBuffers,
    ) -> f64 {
        if self.extensions.is_empty() {
            return 0.0;
        }
        let chains = self.chains.iter().zip(&scratch.chains).enumerate();
        let along: f64 = chains
            .map(|(k, (chain, state))| chain.non_elastic_potential(&self.joints(k, at), state))
            .sum();
        along + self.extensions.potential_beyond_energy(at)
    }

    fn kinetic(&self, at: &MachineState<'_>) -> f64 {
        let &MachineState { q, v, drive, .. } = at;
        // M v through the inertia operator; the rod's part relative to the moving pin is added
        let mut momentum = vec![0.0; v.len()];
        self.subtract_inertia(q, v, &mut momentum);
        let own: f64 = momentum.iter().zip(v).map(|(p, v)| -0.5 * p * v).sum();
        let rod = &self.description.rod;
        let i = self.layout.rod();
        let (s, c) = sin_cos(q[i]);
        let pin = drive.pin[1];
        own + 0.5 * rod.mass * pin.norm_squared()
            + rod.mass * rod.center_of_mass * v[i] * (pin.y * c - pin.x * s)
    }
}
