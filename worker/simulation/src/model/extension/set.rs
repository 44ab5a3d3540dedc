//! Set of all extensions that effects have added to a machine. Extensions of one kind are summed in the order in which
//! they were added.
use super::axial::{Axial, AxialLaws, RopeProperties};
use super::force::Force;
use super::line::{LineForce, OnCoordinate};
use super::profile::{Hollow, Profile};
use super::reading::{Reading, SampleState};
use crate::drive::DriveState;
use crate::linear::Bordered;
use crate::math::spline::Splines;
use crate::model::machine_state::MachineState;
use std::sync::Arc;

/// Set of all extensions that effects have added to a machine.
#[derive(Clone, Debug, Default)]
pub struct Extensions {
    /// Curves added by effects to the crank's turn angle: lead of the crank over uniform rotation \[rad\] as
    /// a function of the uniform turn angle \[rad\].
    phase_leads: Vec<Splines>,
    /// Turn angle of the crank at which the recorded revolution has its zero \[rad\].
    index_offset: f64,
    forces: Vec<Arc<dyn Force>>,
    /// Axial laws of the back rope (0) and of the front rope (1).
    axial: [Vec<Arc<dyn Axial>>; 2],
    profile: Profile,
    /// Largest rise of the back head's surface towards the rope, in addition to the head's own deflection
    /// \[m\].
    rise: f64,
    readings: Vec<Arc<dyn Reading>>,
}

impl Extensions {
    /// Adds a generalised force of an effect to the machine.
    pub fn add_force(&mut self, force: impl Force + 'static) {
        self.forces.push(Arc::new(force));
    }

    /// Adds a force law of an effect on the coordinate with index `coordinate`.
    pub fn add_line_force(&mut self, coordinate: usize, law: impl LineForce + 'static) {
        self.add_force(OnCoordinate { coordinate, law });
    }

    /// Adds an axial law to the back rope (0) or the front rope (1).
    ///
    /// # Panics
    /// If `rope` is neither 0 nor 1.
    pub fn add_axial(&mut self, rope: usize, law: impl Axial + 'static) {
        self.axial[rope].push(Arc::new(law));
    }

    /// Appends a stage to the measuring chain.
    pub fn add_reading(&mut self, reading: impl Reading + 'static) {
        self.readings.push(Arc::new(reading));
    }

    /// Shifts the start of the recorded revolution by a turn angle of the crank \[rad\].
    pub const fn move_index(&mut self, angle: f64) {
        self.index_offset += angle;
    }

    /// Adds a deviation of the crank from uniform rotation: lead \[rad\] as a curve over the uniform turn
    /// angle \[rad\].
    pub fn add_warp(&mut self, ahead: Splines) {
        self.phase_leads.push(ahead);
    }

    /// Adds a hollow to the surface of the back head.
    pub fn add_hollow(&mut self, hollow: Hollow) {
        self.profile.add_profile_change(hollow);
    }

    /// Increases the upper bound \[m\] of the rise of the back head's surface towards the rope, in addition
    /// to the head's own deflection.
    pub fn add_rise(&mut self, rise: f64) {
        self.rise += rise;
    }

    /// Returns angle, rate and acceleration of the crank, including its deviation from uniform rotation, from
    /// those of uniform rotation.
    pub(crate) fn turn(&self, uniform: [f64; 3]) -> [f64; 3] {
        let [turn, rate, acceleration] = uniform;
        let mut warped = uniform;
        for warp in &self.phase_leads {
            let ahead = warp.jet(&warp.place(turn), 0);
            warped[0] += ahead.value;
            warped[1] += ahead.first * rate;
            warped[2] += ahead.first * acceleration + ahead.second * rate * rate;
        }
        warped
    }

    pub(crate) const fn index_offset(&self) -> f64 {
        self.index_offset
    }

    /// Adds the generalised forces of the effects to `force`.
    pub(crate) fn add_forces(&self, at: &MachineState<'_>, force: &mut [f64]) {
        for one in &self.forces {
            one.add(at, force);
        }
    }

    /// Adds the tangent of the generalised forces of the effects to `matrix`.
    pub(crate) fn add_tangent(&self, at: &MachineState<'_>, gamma: f64, matrix: &mut Bordered) {
        for one in &self.forces {
            one.add_tangent(at, gamma, matrix);
        }
    }

    /// Returns the energy stored by the forces of the effects \[J\].
    pub(crate) fn energy(&self, at: &MachineState<'_>) -> f64 {
        self.forces.iter().map(|one| one.energy(at)).sum()
    }

    /// Returns the potential at rest of the effects' forces minus the energy that they store \[J\].
    pub(crate) fn potential_beyond_energy(&self, at: &MachineState<'_>) -> f64 {
        let beyond = |one: &Arc<dyn Force>| one.potential(at) - one.energy(at);
        self.forces.iter().map(beyond).sum()
    }

    /// Returns the power dissipated by the forces of the effects \[W\].
    pub(crate) fn lost(&self, at: &MachineState<'_>) -> f64 {
        self.forces.iter().map(|one| one.lost(at)).sum()
    }

    /// Returns the axial laws of the back rope (0) or the front rope (1); `None` if there are none.
    pub(crate) fn axial<'a>(
        &'a self,
        rope: usize,
        drive: &'a DriveState,
        carrier: RopeProperties,
    ) -> Option<AxialLaws<'a>> {
        let laws = &self.axial[rope];
        (!laws.is_empty()).then_some(AxialLaws {
            laws,
            drive,
            carrier,
        })
    }

    pub(crate) fn has_warps(&self) -> bool {
        !self.phase_leads.is_empty()
    }

    /// Returns whether this set of extensions gives the back head the same surface as the set `other` does.
    pub(crate) fn has_same_profile(&self, other: &Self) -> bool {
        (&self.profile, self.rise) == (&other.profile, other.rise)
    }

    /// Returns the number of axial laws of the back rope and of the front rope.
    pub(crate) fn axial_laws(&self) -> [usize; 2] {
        self.axial.each_ref().map(Vec::len)
    }

    /// Returns whether any rope has axial laws.
    pub(crate) fn has_axial(&self) -> bool {
        self.axial.iter().any(|laws| !laws.is_empty())
    }

    /// Returns whether the set contains neither generalised forces nor axial laws.
    pub(crate) fn is_empty(&self) -> bool {
        self.forces.is_empty() && !self.has_axial()
    }

    /// Returns the deviation of the back head's surface from the nominal circle of its arc; `None` if there
    /// is none.
    pub(crate) fn profile(&self) -> Option<&Profile> {
        (!self.profile.is_flat()).then_some(&self.profile)
    }

    /// Returns an upper bound of the height by which effects raise the back head's surface above the nominal
    /// circle of its arc \[m\].
    pub(crate) fn extra_reach(&self) -> f64 {
        self.profile.highest() + self.rise
    }

    /// Returns whether effects have added stages to the measuring chain.
    pub(crate) fn has_readings(&self) -> bool {
        !self.readings.is_empty()
    }

    /// Returns whether a stage of the measuring chain uses more than the stress and the elapsed share of the
    /// revolution.
    pub(crate) fn readings_need_loads(&self) -> bool {
        self.readings.iter().any(|reading| reading.needs_loads())
    }

    /// Applies all stages of the measuring chain to the readings of one sample.
    pub(crate) fn read(&self, at: &SampleState, stress: &mut [f64; 4]) {
        for reading in &self.readings {
            reading.sample(at, stress);
        }
    }

    /// Applies all stages of the measuring chain to the readings of a whole revolution.
    pub(crate) fn read_series(&self, spacing: f64, stress: &mut [Vec<f64>; 4]) {
        for reading in &self.readings {
            reading.series(spacing, stress);
        }
    }
}
