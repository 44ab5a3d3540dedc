//! Hidden effects in the rope: wire friction, bedding (toe region of the tension curve) and construction
//! stretch.
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use simulation::effect::{Axial, Effect, Extensions, LineForceValue, Memory, Site, Strain};
use simulation::model::description::Description;
use std::sync::Arc;

/// Creates friction between wires: a Bouc-Wen model with an exponent other than 1, `dz/de = 1 - (b sgn(z
/// de) + g) |z / z_y|^n`, integrated from step to step.
pub(super) fn wires(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    let beta = record_shape(shape, "beta_1", draw.between(0.5, 0.8));
    Arc::new(Wires {
        share: size,
        yields: record_shape(shape, "yield_strain_1", draw.log_between(1.5e-4, 6e-4)),
        exponent: record_shape(shape, "exponent_1", draw.between(1.5, 2.5)),
        beta,
    })
}

#[derive(Clone, Copy, Debug)]
struct Wires {
    share: f64,
    yields: f64,
    exponent: f64,
    beta: f64,
}

impl Effect for Wires {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        on_both(extensions, *self);
    }
}

impl HiddenEffect for Wires {}

impl Wires {
    fn slope(&self, z: f64, sense: f64) -> f64 {
        let against = if z * sense > 0.0 {
            self.beta
        } else {
            -self.beta
        };
        // beta + gamma = 1, so that z ends at the yield strain
        1.0 - (against + 1.0 - self.beta) * libm::pow((z / self.yields).abs(), self.exponent)
    }

    /// Integrates the hysteretic variable `z` of the wire friction over a monotonic change of strain by the
    /// classical Runge-Kutta method.
    fn advanced(&self, [strain, z]: Memory, now: f64) -> f64 {
        let moved = now - strain;
        let sense = if moved < 0.0 { -1.0 } else { 1.0 };
        let parts = (moved.abs() / (0.1 * self.yields))
            .ceil()
            .clamp(1.0, 1000.0);
        let step = moved / parts;
        let mut z = z;
        let mut done = 0.0;
        while done < parts {
            let a = self.slope(z, sense);
            let b = self.slope(z + 0.5 * step * a, sense);
            let c = self.slope(z + 0.5 * step * b, sense);
            let d = self.slope(z + step * c, sense);
            z += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
            done += 1.0;
        }
        z
    }
}

impl Axial for Wires {
    fn pull(&self, at: &Strain<'_>) -> LineForceValue {
        let stiffness = self.share * at.stiffness;
        let (z, slope) = at.memory.map_or((0.0, 0.0), |memory| {
            let z = self.advanced(memory, at.strain);
            let sense = if at.strain < memory[0] { -1.0 } else { 1.0 };
            (z, self.slope(z, sense))
        });
        LineForceValue {
            spring: -stiffness * at.strain,
            energy: -0.5 * stiffness * at.strain * at.strain,
            non_conservative: stiffness * z,
            by_place: stiffness * (slope - 1.0),
            ..LineForceValue::default()
        }
    }

    fn next_memory(&self, at: &Strain<'_>) -> Option<Memory> {
        let z = at
            .memory
            .map_or(0.0, |memory| self.advanced(memory, at.strain));
        Some([at.strain, z])
    }
}

/// Creates a rope with a toe region: the strain is `T / EA + e_0 (1 - (1 - T / T_b)^2)` up to the tension
/// `T_b` and `T / EA + e_0` above.
pub(super) fn bedding(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Bedding {
        strain: size,
        tension: record_shape(shape, "bedded_n", draw.log_between(9e4, 1.6e5)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Bedding {
    strain: f64,
    tension: f64,
}

impl Effect for Bedding {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        on_both(extensions, *self);
    }
}

impl HiddenEffect for Bedding {}

impl Bedding {
    /// Returns the tension of the rope \[N\] at a strain, and its derivative by the strain.
    fn tension_at(&self, strain: f64, stiffness: f64) -> [f64; 2] {
        let toe = self.strain / self.tension;
        let straight = 1.0 / stiffness;
        if strain <= 0.0 {
            let slope = 1.0 / (straight + 2.0 * toe);
            return [slope * strain, slope];
        }
        if strain >= self.tension * straight + self.strain {
            return [stiffness * (strain - self.strain), stiffness];
        }
        let linear = straight + 2.0 * toe;
        let root = (linear * linear - 4.0 * toe / self.tension * strain).sqrt();
        [2.0 * strain / (linear + root), 1.0 / root]
    }

    /// Returns the complementary energy of the rope per length: the integral of the strain over the tension
    /// [J/m].
    fn complementary(&self, tension: f64, stiffness: f64) -> f64 {
        let straight = 0.5 * tension * tension / stiffness;
        let u = tension / self.tension;
        let toe = if u <= 0.0 {
            self.strain * tension * u
        } else if u < 1.0 {
            let left = 1.0 - u;
            self.strain * (tension + self.tension / 3.0 * (left * left * left - 1.0))
        } else {
            self.strain * (tension - self.tension / 3.0)
        };
        straight + toe
    }
}

impl Axial for Bedding {
    fn pull(&self, at: &Strain<'_>) -> LineForceValue {
        let [tension, slope] = self.tension_at(at.strain, at.stiffness);
        LineForceValue {
            spring: tension - at.stiffness * at.strain,
            energy: tension * at.strain
                - self.complementary(tension, at.stiffness)
                - 0.5 * at.stiffness * at.strain * at.strain,
            by_place: slope - at.stiffness,
            ..LineForceValue::default()
        }
    }
}

/// Creates construction stretch of the rope: every cylinder of both ropes is longer.
pub(super) fn stretch(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Stretch { length: size })
}

#[derive(Clone, Copy, Debug)]
struct Stretch {
    /// Total construction stretch of the back rope \[m\].
    length: f64,
}

impl Effect for Stretch {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let rope = &mut d.rope;
        rope.pitch *= 1.0 + self.length / (rope.back as f64 * rope.pitch);
    }
}

impl HiddenEffect for Stretch {}

fn on_both<L: Axial + Clone + 'static>(extensions: &mut Extensions, law: L) {
    extensions.add_axial(0, law.clone());
    extensions.add_axial(1, law);
}

#[cfg(test)]
mod tests {
    use super::*;
    use simulation::drive::DriveState;

    fn at(drive: &DriveState, strain: f64, memory: Option<Memory>) -> Strain<'_> {
        Strain {
            drive,
            strain,
            rate: 0.0,
            stiffness: 2e7,
            memory,
        }
    }

    fn drive() -> DriveState {
        DriveState::default()
    }

    #[test]
    fn wires_yield_lose_energy_and_do_not_care_for_steps() {
        let law = Wires {
            share: 0.1,
            yields: 3e-4,
            exponent: 2.0,
            beta: 0.6,
        };
        let follow = |parts: i32| {
            let mut memory = [0.0, 0.0];
            let mut lost = 0.0;
            for [from, to] in [[0.0, 1.5e-3], [1.5e-3, 0.0], [0.0, 1.5e-3], [1.5e-3, 0.0]] {
                for k in 1..=parts {
                    let now = from + (to - from) * f64::from(k) / f64::from(parts);
                    let z = law.advanced(memory, now);
                    lost += 0.5 * (z + memory[1]) * (now - memory[0]);
                    memory = [now, z];
                }
            }
            (memory[1], lost)
        };
        let (fine, lost) = follow(4000);
        let (coarse, _) = follow(7);
        assert!((fine + 3e-4).abs() < 1e-6, "{fine}");
        assert!((coarse - fine).abs() < 1e-7);
        assert!(lost > 0.0);
    }

    #[test]
    fn bedding_solves_its_law_and_derives_from_its_energy() {
        let law = Bedding {
            strain: 7.5e-4,
            tension: 1.1e5,
        };
        let drive = drive();
        for tension in [-2e4, 1e4, 6e4, 1.09e5, 1.4e5] {
            let u = tension / law.tension;
            let toe = if u <= 0.0 {
                2.0 * u
            } else {
                1.0 - (1.0 - u.min(1.0)) * (1.0 - u.min(1.0))
            };
            let strain = tension / 2e7 + law.strain * toe;
            assert!((law.tension_at(strain, 2e7)[0] - tension).abs() < 1e-6);
            let h = 1e-7;
            let [plus, minus] = [h, -h].map(|h| law.pull(&at(&drive, strain + h, None)));
            let along = law.pull(&at(&drive, strain, None));
            let by_energy = (plus.energy - minus.energy) / (2.0 * h);
            assert!((by_energy - along.spring).abs() < 1e-2, "{tension}");
            let slope = (plus.spring - minus.spring) / (2.0 * h);
            assert!((slope - along.by_place).abs() < 1e-4 * 2e7, "{tension}");
        }
    }
}
