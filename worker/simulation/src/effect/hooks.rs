//! Where effects take hold of a machine: kinds of piece that an effect may hang there.
//!
//! A machine without effects has an empty set of them and computes what it always did. Nothing here
//! knows which effect a piece belongs to. Pieces of one kind add up in the order of the catalogue.
use super::line::Along;
use super::profile::{Hollow, Profile};
use crate::drive::DriveState;
use crate::linear::Bordered;
use crate::math::spline::Splines;
use crate::model::{Individual, Instant};
use std::fmt::Debug;
use std::sync::Arc;

/// Everything that effects have hung on a machine.
#[derive(Clone, Debug, Default)]
pub struct Hooks {
    /// What the crank is ahead of uniform rotation \[rad\], over the uniform turn angle \[rad\].
    pub(super) warps: Vec<Splines>,
    /// How far behind the record's zero the crank's zero lies \[rad\].
    pub(super) index_offset: f64,
    pub(super) forces: Vec<Arc<dyn Force>>,
    /// Of the back rope and of the front rope.
    pub(super) axial: [Vec<Arc<dyn Axial>>; 2],
    pub(super) profile: Profile,
    /// How far the back head's surface may move towards the rope beside its own deflection \[m\].
    pub(super) sway: f64,
    pub(super) readings: Vec<Arc<dyn Reading>>,
}

/// A generalised force.
pub trait Force: Debug + Send + Sync {
    /// Adds it.
    fn add(&self, at: &Instant<'_>, force: &mut [f64]);

    /// Adds its part of `-K - gamma D`, with `K` and `D` its derivatives by coordinates and rates.
    fn add_tangent(&self, at: &Instant<'_>, gamma: f64, matrix: &mut Bordered);

    /// Energy that it stores \[J\].
    fn energy(&self, at: &Instant<'_>) -> f64;

    /// Potential from which it derives at rest and at a fixed time, stored energy included \[J\].
    fn potential(&self, at: &Instant<'_>) -> f64;

    /// Power that it takes out of the machine beyond what it stores \[W\].
    fn lost(&self, at: &Instant<'_>) -> f64;
}

/// A force along a rope between two cylinders, as a law of its strain; positive where it pulls.
pub trait Axial: Debug + Send + Sync {
    /// Pull \[N\] at a strain \[1\] and its rate [1/s]; energies are per length [J/m].
    fn pull(&self, at: &Strain<'_>) -> Along;

    /// What the law wants to know at the next step of this joint.
    fn remember(&self, _at: &Strain<'_>) -> Option<Memory> {
        None
    }
}

/// State of a law with a past: strain \[1\] and inner variable at the last accepted step.
pub type Memory = [f64; 2];

/// A joint of a rope.
#[derive(Clone, Copy, Debug)]
pub struct Strain<'a> {
    /// Crank and load.
    pub drive: &'a DriveState,
    /// Strain \[1\].
    pub strain: f64,
    /// Its rate [1/s].
    pub rate: f64,
    /// Stiffness of the individual's rope, force per strain \[N\].
    pub stiffness: f64,
    /// What the law remembered; nothing before the run has begun to move.
    pub memory: Option<Memory>,
}

/// The laws along one rope at an instant.
#[derive(Clone, Copy, Debug)]
pub struct AxialLaws<'a> {
    laws: &'a [Arc<dyn Axial>],
    drive: &'a DriveState,
    /// Force per strain of all ropes of a head together \[N\], and what of the laws one rope carries.
    stiffness: f64,
    share: f64,
    /// Length of rope that a joint stands for \[m\].
    length: f64,
}

impl AxialLaws<'_> {
    /// Sum of the laws at an extension \[m\] and its rate [m/s]; derivatives by those, energy in J.
    pub fn pull(&self, extension: f64, rate: f64, memory: Option<Memory>) -> Along {
        let at = self.strain(extension, rate, memory);
        let mut sum = Along::default();
        for law in self.laws {
            let one = law.pull(&at);
            sum.spring += one.spring;
            sum.other += one.other;
            sum.energy += one.energy * self.length;
            sum.by_place += one.by_place / self.length;
            sum.by_rate += one.by_rate / self.length;
        }
        Along {
            spring: sum.spring * self.share,
            other: sum.other * self.share,
            energy: sum.energy * self.share,
            by_place: sum.by_place * self.share,
            by_rate: sum.by_rate * self.share,
        }
    }

    /// What the one law with a past wants to know at the next step.
    pub fn remember(&self, extension: f64, rate: f64, memory: Option<Memory>) -> Option<Memory> {
        let at = self.strain(extension, rate, memory);
        self.laws.iter().find_map(|law| law.remember(&at))
    }

    const fn strain(&self, extension: f64, rate: f64, memory: Option<Memory>) -> Strain<'_> {
        Strain {
            drive: self.drive,
            strain: extension / self.length,
            rate: rate / self.length,
            stiffness: self.stiffness,
            memory,
        }
    }
}

/// A link of the chain from strain to reading.
pub trait Reading: Debug + Send + Sync {
    /// Changes the reading of one sample \[Pa\].
    fn sample(&self, _at: &Sampled<'_, '_>, _stress: &mut [f64; 4]) {}

    /// Changes the readings of a whole revolution, samples `spacing` \[s\] apart and periodic.
    fn series(&self, _spacing: f64, _stress: &mut [Vec<f64>; 4]) {}
}

/// A sample of the recorded revolution.
#[derive(Clone, Copy, Debug)]
pub struct Sampled<'a, 'b> {
    /// The machine with the loads of the sample.
    pub individual: &'a Individual<'b>,
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Share of the recorded revolution that is over, 0 to 1.
    pub elapsed: f64,
}

impl Hooks {
    /// Hangs a force on the machine.
    pub fn add_force(&mut self, force: Arc<dyn Force>) {
        self.forces.push(force);
    }

    /// Adds a law along the back rope (0) or the front rope (1); one of them may have a past.
    ///
    /// # Panics
    /// If there is no such rope.
    pub fn add_axial(&mut self, rope: usize, law: Arc<dyn Axial>) {
        self.axial[rope].push(law);
    }

    /// Lets the crank go ahead of uniform rotation \[rad\], by a curve over the uniform turn \[rad\].
    pub fn add_warp(&mut self, ahead: Splines) {
        self.warps.push(ahead);
    }

    /// Takes material from the back head's surface.
    pub fn dig(&mut self, hollow: Hollow) {
        self.profile.dig(hollow);
    }

    /// Lets the back head's surface move towards the rope beside its own deflection, by no more
    /// than this \[m\].
    pub fn add_sway(&mut self, sway: f64) {
        self.sway += sway;
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

    /// The laws along a rope, if it has any; `stiffness` of all ropes on its head, `share` of one.
    pub(crate) fn axial<'a>(
        &'a self,
        chain: usize,
        drive: &'a DriveState,
        (stiffness, share): (f64, f64),
        length: f64,
    ) -> Option<AxialLaws<'a>> {
        let laws = &self.axial[chain];
        (!laws.is_empty()).then_some(AxialLaws {
            laws,
            drive,
            stiffness,
            share,
            length,
        })
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
        self.profile.highest() + self.sway
    }

    /// Whether readings ask for more than the stress.
    pub(crate) fn has_readings(&self) -> bool {
        !self.readings.is_empty()
    }

    /// Reads one sample.
    pub(crate) fn read(&self, at: &Sampled<'_, '_>, stress: &mut [f64; 4]) {
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
