//! Equations of motion of a machine with the ropes and the drive of one individual.
use crate::drive::{Drive, DriveState};
use crate::element::impact::DerivativeVariable;
use crate::linear::{Bordered, MatrixEntry};
use crate::math::elementary::sin_cos;
use crate::model::chain::unit_loads::UnitLoads;
use crate::model::extension::{Extensions, MemoryDerivatives};
use crate::model::force_buffers::ForceBuffers;
use crate::model::forces::Terms;
use crate::model::machine::Machine;
use crate::model::machine_state::MachineState;
use crate::model::ropes::Ropes;
use crate::norm::{ANGLE, LENGTH, MODAL, cylinders_error, cylinders_newton, square, worst};
use crate::system::{Equations, LoadedState, Loads, Powers, State, StateRef, StateShift, Static};
use nalgebra::{Vector2, Vector3};

/// Machine, ropes and drive of one individual, with the loads of the last evaluation.
#[derive(Debug)]
pub struct RopeMachine<'a> {
    /// Machine whose equations are evaluated, shared by all individuals.
    pub machine: &'a Machine,
    /// Rope and contact coefficients of the individual.
    pub ropes: Ropes,
    /// Crank motion and suspension load over time.
    pub drive: Drive,
    /// Poses and loads of the last force evaluation.
    pub scratch: ForceBuffers,
    load_share: f64,
    at: (f64, DriveState),
}

impl<'a> RopeMachine<'a> {
    /// Creates the equations of motion of an individual from machine, ropes and drive, and allocates their
    /// buffers.
    pub fn new(machine: &'a Machine, ropes: Ropes, drive: Drive) -> Self {
        Self::within(machine, ropes, drive, ForceBuffers::new(machine))
    }

    /// Creates the equations of motion as [`Self::new`] does, but reuses the buffers of an individual with
    /// the same layout; the caller may take them back from the field `scratch`.
    pub(crate) fn within(
        machine: &'a Machine,
        ropes: Ropes,
        drive: Drive,
        scratch: ForceBuffers,
    ) -> Self {
        Self {
            machine,
            ropes,
            drive,
            scratch,
            load_share: 1.0,
            // of no time: the first question fills it
            at: (f64::NAN, DriveState::default()),
        }
    }

    /// Returns the state of crank and load at time `t`.
    pub fn drive_state(&mut self, t: f64) -> DriveState {
        self.move_to(t);
        self.at.1
    }

    fn move_to(&mut self, t: f64) {
        if t.to_bits() != self.at.0.to_bits() {
            let mut state = self.machine.drive_state(&self.drive, t);
            state.load *= self.load_share;
            self.at = (t, state);
        }
    }

    fn instant<'s>(&'s self, at: StateRef<'s>) -> MachineState<'s> {
        instant(&self.ropes, &self.at.1, at)
    }

    /// Multiplies the load at the suspension point by a share for all later evaluations.
    pub fn scale_load(&mut self, share: f64) {
        self.load_share = share;
        self.at.0 = f64::NAN;
    }

    /// Returns the force of the back ropes on the back head, contact and anchor together, in the world frame
    /// W \[N\].
    ///
    /// Computed from the balance of forces along the load path: wrapped rope and head together are pulled by
    /// the joint before the first cylinder in contact.
    pub fn head_push(&self) -> [f64; 2] {
        let mut push = [0.0; 2];
        for back in &self.scratch.chains[..self.machine.faces.len()] {
            let first = back.contact.iter().position(|&force| force > 0.0);
            let joint = first.unwrap_or(self.machine.layout.back);
            // the joint's force on its outer cylinder points back along the free rope
            let force = back.joint_force(joint);
            push[0] += force.x;
            push[1] += force.y;
        }
        push
    }

    /// Returns the force of the rope's fixed end on the back head, in the beam frame \[N\].
    pub(crate) fn anchor_pull(&mut self, at: StateRef<'_>) -> [f64; 2] {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        let joints = self.machine.joints(0, &instant);
        let load = self.machine.chains[0].head_load(&joints, at.q, at.v);
        let (s, c) = sin_cos(at.q[self.machine.layout.beam()]);
        load.map_or([0.0; 2], |load| {
            let [x, y] = [load.force.x, load.force.y];
            [c * x + s * y, c * y - s * x]
        })
    }

    /// Returns the force that the back ropes' base joints, at the crossbeam, exert on the first cylinders
    /// \[N\].
    pub(crate) fn base_pull(&mut self, at: StateRef<'_>) -> Vector3<f64> {
        self.move_to(at.t);
        let machine = self.machine;
        let instant = instant(&self.ropes, &self.at.1, at);
        let back = machine.chains[..machine.faces.len()].iter().enumerate();
        back.filter_map(|(k, chain)| chain.base_load(&machine.joints(k, &instant), at.q, at.v))
            .fold(Vector3::zeros(), |sum, load| sum + load.force)
    }

    /// Returns the force of the crank pin on the rod at a state \[N\]; independent of the loads of the last
    /// evaluation.
    pub(crate) fn pin_force(&mut self, state: &State) -> Vector2<f64> {
        let pull = self.base_pull(state.motion());
        let at = instant(&self.ropes, &self.at.1, state.motion());
        self.machine.pin_force_under(&at, &state.a, pull)
    }

    /// Returns the tensions in the base joints of the ropes of the back head (0) or the front head (1) \[N\].
    pub fn base_tensions(&self, rope: usize) -> impl Iterator<Item = f64> + '_ {
        let all = self.machine.strands.iter().zip(&self.scratch.chains);
        let on_head = all.filter(move |(strand, _)| strand.rope == rope);
        on_head.map(|(_, state)| state.joints[0].force.norm())
    }

    /// Computes the loads that the back head's stress depends on; all other loads keep their values. `force`
    /// is workspace for generalised forces.
    pub fn back_head_loads<'s>(
        &'s mut self,
        at: StateRef<'s>,
        force: &mut [f64],
    ) -> BackHeadLoads<'s, 'a> {
        self.move_to(at.t);
        let scratch = &mut self.scratch;
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine.back_head_loads(&instant, scratch, force);
        BackHeadLoads {
            individual: self,
            at,
        }
    }

    /// Returns the loads of the last evaluation, which must have been one of all loads at the state `at`.
    pub(crate) const fn held_loads<'s>(&'s self, at: StateRef<'s>) -> BackHeadLoads<'s, 'a> {
        BackHeadLoads {
            individual: self,
            at,
        }
    }

    /// Computes all loads, including those that the back head's stress depends on; `force` receives the
    /// generalised forces.
    pub(crate) fn all_loads<'s>(
        &'s mut self,
        at: StateRef<'s>,
        force: &mut [f64],
    ) -> BackHeadLoads<'s, 'a> {
        self.forces(at, force);
        BackHeadLoads {
            individual: self,
            at,
        }
    }

    /// Computes the selected terms of the generalised forces, using the poses of the last evaluation.
    pub(crate) fn posed_forces(&mut self, at: StateRef<'_>, terms: Terms, force: &mut [f64]) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine
            .posed_forces(&instant, terms, &mut self.scratch, force);
    }

    /// Computes the generalised forces of extensions that are not part of this machine, using the poses of the
    /// last evaluation. `units` are the result of [`Self::unit_loads`], or empty.
    pub(crate) fn forces_of(
        &mut self,
        extensions: &Extensions,
        at: StateRef<'_>,
        units: &[UnitLoads],
        force: &mut [f64],
    ) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine
            .forces_of(extensions, &instant, (&self.scratch, units), force);
    }

    /// Computes the loads of all rope joints per unit of each of their coefficients, at the poses of the last
    /// evaluation in the plane: one element per chain, or none, if they are not required.
    pub(crate) fn unit_loads(&mut self, at: StateRef<'_>, units: &mut [UnitLoads]) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine.unit_loads(&instant, &self.scratch, units);
    }

    /// Computes the derivatives that concern the memory of the axial laws, one list per chain, at the poses and the
    /// memory of the last evaluation, for which `units` were computed.
    pub(crate) fn memory_derivatives(
        &mut self,
        at: StateRef<'_>,
        units: &[UnitLoads],
        out: &mut [Vec<MemoryDerivatives>],
    ) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine
            .memory_derivatives(&instant, (&self.scratch, units), out);
    }

    /// Adds `factor` times the generalised forces of all rope joints under unit coefficients; see
    /// [`Machine::add_unit_forces`].
    pub(crate) fn add_unit_forces<T>(
        &mut self,
        at: StateRef<'_>,
        unit: (&Ropes, Option<(usize, f64)>),
        units: (&[UnitLoads], f64),
        force: &mut [T],
        entry: impl Fn(&mut T) -> &mut f64,
    ) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine
            .add_unit_forces(&instant, unit, units, force, entry);
    }

    /// Computes the derivative of the contact forces on the selected heads with respect to a contact
    /// quantity, at the contact points of the last evaluation.
    pub(crate) fn contact_by(
        &mut self,
        at: StateRef<'_>,
        by: (DerivativeVariable, [bool; 2]),
        force: &mut [f64],
    ) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine
            .contact_by(&instant, by, &mut self.scratch, force);
    }

    /// Updates the memory of the axial laws in all rope joints from a state that the integrator has accepted.
    pub fn update_memory(&mut self, state: &State) {
        if !self.machine.extensions.has_axial() {
            return;
        }
        self.move_to(state.t);
        self.machine.pose(&state.q, &state.v, &mut self.scratch);
        let at = instant(&self.ropes, &self.at.1, state.motion());
        for (k, chain) in self.machine.chains.iter().enumerate() {
            let joints = self.machine.joints(k, &at);
            chain.update_memory(&joints, &mut self.scratch.chains[k]);
        }
    }

    /// Returns kinetic plus potential energy \[J\], without the potential of the load on the suspension
    /// point.
    pub fn energy(&mut self, state: &State) -> f64 {
        self.move_to(state.t);
        self.machine.pose(&state.q, &state.v, &mut self.scratch);
        let at = instant(&self.ropes, &self.at.1, state.motion());
        self.machine.touch(&at, &mut self.scratch);
        self.machine.energy(&at, &self.scratch)
    }
}

/// Individual and state for which the loads on the back head have been computed, as stress recovery requires.
#[derive(Debug)]
pub struct BackHeadLoads<'s, 'a> {
    individual: &'s RopeMachine<'a>,
    at: StateRef<'s>,
}

impl<'s, 'a> BackHeadLoads<'s, 'a> {
    /// Creates the argument of stress recovery from a state at which all loads have been evaluated.
    pub fn of(loads: &'s Loads<'_, 's, RopeMachine<'a>>) -> Self {
        Self {
            individual: loads.equations(),
            at: loads.state(),
        }
    }

    /// Returns the individual whose loads on the back head are held.
    pub const fn individual(&self) -> &'s RopeMachine<'a> {
        self.individual
    }

    /// Returns the state at which the loads on the back head were evaluated.
    pub const fn state(&self) -> StateRef<'s> {
        self.at
    }
}

const fn instant<'s>(
    ropes: &'s Ropes,
    drive: &'s DriveState,
    at: StateRef<'s>,
) -> MachineState<'s> {
    MachineState {
        ropes,
        drive,
        q: at.q,
        v: at.v,
    }
}

impl Equations for RopeMachine<'_> {
    fn matrix(&self) -> Bordered {
        self.machine.layout.matrix()
    }

    fn forces(&mut self, at: StateRef<'_>, force: &mut [f64]) {
        self.move_to(at.t);
        let instant = instant(&self.ropes, &self.at.1, at);
        self.machine.forces(&instant, &mut self.scratch, force);
    }

    fn subtract_inertia<T: MatrixEntry>(&self, q: &[f64], a: &[T], out: &mut [T]) {
        self.machine.subtract_inertia(q, a, out);
    }

    fn tangent(&self, at: LoadedState<'_>, shift: StateShift, matrix: &mut Bordered) {
        let instant = self.instant(at.state());
        let scratch = &self.scratch;
        self.machine
            .tangent(&instant, shift, scratch, (None, matrix));
    }

    fn tangents(
        &self,
        at: LoadedState<'_>,
        shift: StateShift,
        [stiffness, matrix]: [&mut Bordered; 2],
    ) {
        let instant = self.instant(at.state());
        let both = (Some(stiffness), matrix);
        self.machine.tangent(&instant, shift, &self.scratch, both);
    }

    fn add_velocity_inertia_tangent(
        &self,
        at: StateRef<'_>,
        a: &[f64],
        damping: f64,
        matrix: &mut Bordered,
    ) {
        for chain in &self.machine.chains {
            chain.add_spin_tangent(at, a, damping, matrix);
        }
    }

    fn newton_norm(&self, change: &[f64]) -> f64 {
        let layout = self.machine.layout;
        let width = layout.motion.width();
        let mut norm = worst(0.0, change[layout.rod()] / ANGLE);
        norm = worst(norm, change[layout.suspension()] / LENGTH);
        for chain in &self.machine.chains {
            norm = cylinders_newton(norm, &change[chain.range()], width);
        }
        norm = worst(norm, change[layout.beam()] / ANGLE);
        for k in 0..layout.modes {
            norm = worst(norm, change[layout.mode(k)] / MODAL);
        }
        norm
    }

    /// Returns the larger of the root mean square of the scaled errors in rod, suspension, beam and modal
    /// coordinates and the largest scaled error of a cylinder, which has a looser tolerance.
    fn error_norm(&self, error: &[f64]) -> f64 {
        let layout = self.machine.layout;
        let width = layout.motion.width();
        let mut sum = square(error[layout.rod()] / 5e-5)
            + square(error[layout.suspension()] / 5e-5)
            + square(error[layout.beam()] / 1e-5);
        for k in 0..layout.modes {
            sum += square(error[layout.mode(k)] / 2e-5);
        }
        let norm = (sum / (3 + layout.modes) as f64).sqrt();
        self.machine.chains.iter().fold(norm, |norm, chain| {
            cylinders_error(norm, &error[chain.range()], width)
        })
    }

    fn powers(&self, at: LoadedState<'_>, a: &[f64]) -> Powers {
        let instant = self.instant(at.state());
        self.machine.powers(&instant, a, &self.scratch)
    }
}

impl Static for RopeMachine<'_> {
    fn potential(&self, at: LoadedState<'_>) -> f64 {
        let at = self.instant(at.state());
        self.machine.potential(&at, &self.scratch)
            + self.machine.potential_beyond_energy(&at, &self.scratch)
            + at.drive.load * at.q[self.machine.layout.suspension()]
    }

    /// Adds a weight `lambda` to the diagonal for each coordinate, scaled so that a metre of displacement of
    /// a cylinder, of the beam's tip or of the suspension counts equally.
    fn add_static_weight(&self, lambda: f64, matrix: &mut Bordered) {
        let layout = self.machine.layout;
        for base in [layout.rod(), layout.suspension()] {
            matrix.add(base, base, lambda);
        }
        for chain in &self.machine.chains {
            chain.add_static_weight(lambda, matrix);
        }
        let arm = self.machine.description.front_arc.radius;
        matrix.add_corner(0, 0, lambda * arm * arm);
    }
}
