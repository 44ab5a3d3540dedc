//! Outcome of a simulation. Every run ends with one of these verdicts; none hangs or panics.
use crate::model::RopeMachine;
use crate::model::layout::Motion;

/// Reason why a simulation ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failure {
    /// A rope joint stretched beyond [`Limits::extension`].
    OverstretchedRope,
    /// The rope sank into a head beyond [`Limits::penetration`].
    RopeThroughHead,
    /// The beam rose above its range of swing by more than [`Limits::beam_margin`].
    BeamOvertravel,
    /// The beam stayed below its range of swing by more than [`Limits::beam_margin`].
    LoadNotLifted,
    /// A cylinder rotated out of the machine's plane, or cylinders buckled sideways because their shear
    /// stiffness cannot hold them under tension.
    TumbledCylinder,
    /// The step size fell below its limit.
    StepUnderflow,
    /// The budget of Newton iterations was used up.
    Budget,
}

/// Progress that a failed simulation had made when it ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    /// Share of the static load that the machine still carried (failure during the search for equilibrium).
    LoadFraction(f64),
    /// Share of the simulated time that was completed (failure in motion).
    TimeFraction(f64),
}

/// Outcome of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// The simulation reached the end of the revolution.
    Complete,
    /// The simulation ended early.
    Failed {
        /// Reason why the simulation ended early.
        kind: Failure,
        /// Progress made before the failure.
        reached: Reached,
    },
}

/// Limits of plausible motion; a simulation that exceeds one ends as failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Largest extension of a rope joint, in cylinder pitches.
    pub extension: f64,
    /// Deepest penetration of the rope into a head \[m\].
    pub penetration: f64,
    /// Margin by which the beam may leave the range of swing of the inextensible mechanism \[rad\].
    pub beam_margin: f64,
    /// Largest sine of a cylinder's angle out of the machine's plane.
    pub tilt: f64,
}

impl Default for Limits {
    fn default() -> Self {
        Self {
            extension: 0.5,
            penetration: 0.1,
            beam_margin: 0.2,
            tilt: 0.9,
        }
    }
}

impl Limits {
    /// Returns the first limit that an individual exceeds at coordinates `q`, if any. The individual's last
    /// loads must belong to `q` up to Newton's accuracy; `swing` is the range of the beam angle of the
    /// inextensible mechanism \[rad\].
    pub fn first_exceeded(
        &self,
        individual: &RopeMachine<'_>,
        q: &[f64],
        swing: [f64; 2],
    ) -> Option<Failure> {
        let RopeMachine {
            machine,
            ropes,
            scratch,
            ..
        } = individual;
        let most = ropes
            .joint
            .tension_at(self.extension * machine.description.rope.pitch);
        for state in &scratch.chains {
            if (0..state.joints.len()).any(|joint| state.tension(joint) > most) {
                return Some(Failure::OverstretchedRope);
            }
        }
        if scratch.max_penetration() > self.penetration {
            return Some(Failure::RopeThroughHead);
        }
        let beam = q[machine.layout.beam()];
        if beam > swing[1] + self.beam_margin {
            return Some(Failure::BeamOvertravel);
        }
        if beam.is_nan() || beam < swing[0] - self.beam_margin {
            return Some(Failure::LoadNotLifted);
        }
        if machine.layout.motion == Motion::Plane {
            return None;
        }
        for chain in &machine.chains {
            for q in q[chain.range()].chunks_exact(6) {
                let tilt = q[4];
                if tilt.is_nan() || crate::math::elementary::sin_cos(tilt).0.abs() > self.tilt {
                    return Some(Failure::TumbledCylinder);
                }
            }
        }
        None
    }
}
