//! Toe region of the ropes, soft until the wires have bedded: strain `T / EA + e_0 (1 - exp(-T / T_0))`.
//!
//! The law is solved for the tension at a strain; the difference from the linear law of the evaluated rope
//! coefficients is added between all cylinders of both ropes. Below zero tension the law continues with its
//! slope at zero.
//!
//! Source: modulus that grows with stress: Feyrer, *Wire Ropes*, 2nd ed. (2015).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::exp;
use crate::model::extension::{Axial, Effect, Extensions, LineForceValue, Site, Strain};
use crate::model::parallel_ropes::{BACK, FRONT};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new("rope_toe", "Soft toe of the ropes at low tension")
        .with_location("back_rope", Place::Dynamics)
        .size("strain", Unit::One, 7.5e-4, [0.0, 0.01])
        .shape("tension", Unit::Newton, 6e4, [5e3, 5e5])
        .with_constructor(|v| Toe {
            strain: v.get("strain"),
            tension: v.get("tension"),
        })
}

#[derive(Clone, Copy, Debug)]
struct Toe {
    strain: f64,
    tension: f64,
}

impl Effect for Toe {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        for rope in [BACK, FRONT] {
            extensions.add_axial(rope, *self);
        }
    }
}

impl Toe {
    /// Computes the strain at a tension \[N\] and its derivative, for a rope of stiffness `EA` \[N\].
    fn strain_at(&self, tension: f64, stiffness: f64) -> [f64; 2] {
        let straight = tension / stiffness;
        let slope = 1.0 / stiffness;
        let u = tension / self.tension;
        if u <= 0.0 {
            let toe = self.strain / self.tension;
            return [straight + toe * tension, slope + toe];
        }
        let left = exp(-u);
        [
            straight + self.strain * (1.0 - left),
            slope + self.strain * left / self.tension,
        ]
    }
}

impl Axial for Toe {
    fn pull(&self, at: &Strain<'_>) -> LineForceValue {
        // strain over tension is concave: from the left of the root Newton's method climbs to it
        // without overshooting, and the stiffest slope lies left of it
        let steepest = 1.0 / at.stiffness + self.strain / self.tension;
        let mut tension = at.strain / steepest;
        let mut slope = steepest;
        for _ in 0..40 {
            let [strain, by_tension] = self.strain_at(tension, at.stiffness);
            slope = by_tension;
            let change = (at.strain - strain) / by_tension;
            tension += change;
            if change.abs() <= 1e-13 * (tension.abs() + 1.0) {
                break;
            }
        }
        let u = tension / self.tension;
        // energy per length: tension times strain less the complementary energy
        let complementary = 0.5 * tension * tension / at.stiffness
            + if u <= 0.0 {
                0.5 * self.strain * tension * u
            } else {
                self.strain * (tension - self.tension * (1.0 - exp(-u)))
            };
        LineForceValue {
            spring: tension - at.stiffness * at.strain,
            energy: tension * at.strain
                - complementary
                - 0.5 * at.stiffness * at.strain * at.strain,
            by_place: 1.0 / slope - at.stiffness,
            ..LineForceValue::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::DriveState;

    #[test]
    fn the_pull_solves_the_law_and_derives_from_its_energy() {
        let toe = Toe {
            strain: 7.5e-4,
            tension: 6e4,
        };
        let drive = DriveState::default();
        let at = |strain: f64| {
            let at = Strain {
                drive: &drive,
                strain,
                rate: 0.0,
                stiffness: 2e7,
                memory: None,
            };
            (toe.pull(&at), at)
        };
        for strain in [-1e-3, 1e-5, 1e-3, 6e-3] {
            let (along, s) = at(strain);
            let tension = along.spring + s.stiffness * strain;
            assert!((toe.strain_at(tension, s.stiffness)[0] - strain).abs() < 1e-15);
            let h = 1e-7;
            let (plus, minus) = (at(strain + h).0, at(strain - h).0);
            let by_energy = (plus.energy - minus.energy) / (2.0 * h);
            assert!(
                (by_energy - along.spring).abs() < 1e-3,
                "{strain}: {by_energy} {along:?}"
            );
            let slope = (plus.spring - minus.spring) / (2.0 * h);
            assert!(
                (slope - along.by_place).abs() < 1e-5 * s.stiffness,
                "{strain}"
            );
        }
    }
}
