//! Everything that effects have hung on one machine. Pieces of one kind add up in the order in which
//! they were hung there.
use super::axial::{Axial, AxialLaws, Carrier};
use super::force::Force;
use super::line::{LineForce, OnCoordinate};
use super::profile::{Hollow, Profile};
use super::reading::{Reading, Sampled};
use crate::drive::DriveState;
use crate::linear::Bordered;
use crate::math::spline::Splines;
use crate::model::instant::Instant;
use std::sync::Arc;

/// Everything that effects have hung on a machine.
#[derive(Clone, Debug, Default)]
pub struct Hooks {
    /// What the crank is ahead of uniform rotation \[rad\], over the uniform turn angle \[rad\].
    warps: Vec<Splines>,
    /// How far behind the record's zero the crank's zero lies \[rad\].
    index_offset: f64,
    forces: Vec<Arc<dyn Force>>,
    /// Of the back rope and of the front rope.
    axial: [Vec<Arc<dyn Axial>>; 2],
    profile: Profile,
    /// How far the back head's surface may rise towards the rope beside its own deflection \[m\].
    rise: f64,
    readings: Vec<Arc<dyn Reading>>,
}

impl Hooks {
    /// Hangs a force on the machine.
    pub fn add_force(&mut self, force: impl Force + 'static) {
        self.forces.push(Arc::new(force));
    }

    /// Hangs a law on one coordinate.
    pub fn on(&mut self, coordinate: usize, law: impl LineForce + 'static) {
        self.add_force(OnCoordinate { coordinate, law });
    }

    /// Adds a law along the back rope (0) or the front rope (1).
    ///
    /// # Panics
    /// If there is no such rope.
    pub fn add_axial(&mut self, rope: usize, law: impl Axial + 'static) {
        self.axial[rope].push(Arc::new(law));
    }

    /// Adds a link of the chain from strain to reading, behind those that are there.
    pub fn add_reading(&mut self, reading: impl Reading + 'static) {
        self.readings.push(Arc::new(reading));
    }

    /// Moves the crank's zero behind the record's by so much more \[rad\].
    pub const fn move_index(&mut self, angle: f64) {
        self.index_offset += angle;
    }

    /// Lets the crank go ahead of uniform rotation \[rad\], by a curve over the uniform turn \[rad\].
    pub fn add_warp(&mut self, ahead: Splines) {
        self.warps.push(ahead);
    }

    /// Takes material from the back head's surface.
    pub fn dig(&mut self, hollow: Hollow) {
        self.profile.dig(hollow);
    }

    /// Lets the back head's surface rise towards the rope beside its own deflection, by no more
    /// than this \[m\].
    pub fn add_rise(&mut self, rise: f64) {
        self.rise += rise;
    }

    /// Turn angle, rate and acceleration of the crank, from those of uniform rotation.
    pub(crate) fn turn(&self, uniform: [f64; 3]) -> [f64; 3] {
        let [turn, rate, acceleration] = uniform;
        let mut warped = uniform;
        for warp in &self.warps {
            let ahead = warp.jet(&warp.place(turn), 0);
            warped[0] += ahead.value;
            warped[1] += ahead.first * rate;
            warped[2] += ahead.first * acceleration + ahead.second * rate * rate;
        }
        warped
    }

    /// How far behind the record's zero the crank's zero lies \[rad\].
    pub(crate) const fn index_offset(&self) -> f64 {
        self.index_offset
    }

    /// Adds the forces.
    pub(crate) fn add_forces(&self, at: &Instant<'_>, force: &mut [f64]) {
        for one in &self.forces {
            one.add(at, force);
        }
    }

    /// Adds their tangent.
    pub(crate) fn add_tangent(&self, at: &Instant<'_>, gamma: f64, matrix: &mut Bordered) {
        for one in &self.forces {
            one.add_tangent(at, gamma, matrix);
        }
    }

    /// Energy that they store \[J\].
    pub(crate) fn energy(&self, at: &Instant<'_>) -> f64 {
        self.forces.iter().map(|one| one.energy(at)).sum()
    }

    /// What of their potential at rest is no stored energy \[J\].
    pub(crate) fn potential_beyond_energy(&self, at: &Instant<'_>) -> f64 {
        let beyond = |one: &Arc<dyn Force>| one.potential(at) - one.energy(at);
        self.forces.iter().map(beyond).sum()
    }

    /// Power that they take \[W\].
    pub(crate) fn lost(&self, at: &Instant<'_>) -> f64 {
        self.forces.iter().map(|one| one.lost(at)).sum()
    }

    /// The laws along the back rope (0) or the front rope (1), if it has any.
    pub(crate) fn axial<'a>(
        &'a self,
        rope: usize,
        drive: &'a DriveState,
        carrier: Carrier,
    ) -> Option<AxialLaws<'a>> {
        let laws = &self.axial[rope];
        (!laws.is_empty()).then_some(AxialLaws {
            laws,
            drive,
            carrier,
        })
    }

    /// Whether the crank leaves uniform rotation.
    pub(crate) fn has_warps(&self) -> bool {
        !self.warps.is_empty()
    }

    /// Whether the back head's surface is another one with other pieces.
    pub(crate) fn digs_as(&self, other: &Self) -> bool {
        (&self.profile, self.rise) == (&other.profile, other.rise)
    }

    /// Whether there are laws along a rope.
    pub(crate) fn has_axial(&self) -> bool {
        self.axial.iter().any(|laws| !laws.is_empty())
    }

    /// Whether there is nothing that acts on the motion of bodies.
    pub(crate) fn is_empty(&self) -> bool {
        self.forces.is_empty() && !self.has_axial()
    }

    /// What the back head's surface lacks, if anything.
    pub(crate) fn profile(&self) -> Option<&Profile> {
        (!self.profile.is_flat()).then_some(&self.profile)
    }

    /// How much farther from the arc's centre than without effects the rope may touch \[m\].
    pub(crate) fn bulge(&self) -> f64 {
        self.profile.highest() + self.rise
    }

    /// Whether readings ask for more than the stress.
    pub(crate) fn has_readings(&self) -> bool {
        !self.readings.is_empty()
    }

    /// Reads one sample.
    pub(crate) fn read(&self, at: &Sampled, stress: &mut [f64; 4]) {
        for reading in &self.readings {
            reading.sample(at, stress);
        }
    }

    /// Reads a whole revolution.
    pub(crate) fn read_series(&self, spacing: f64, stress: &mut [Vec<f64>; 4]) {
        for reading in &self.readings {
            reading.series(spacing, stress);
        }
    }
}
