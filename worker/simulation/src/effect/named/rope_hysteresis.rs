//! Friction between the wires of a rope: Bouc-Wen hysteresis along both ropes.
//!
//! `T = (1 - a) EA e + a EA z`, `dz/de = 1 - (sgn(z de) + 1) |z| / 2 e_y` (exponent 1, `beta = gamma`): a
//! share `a` of the rope's stiffness slips gradually and carries at most `a EA e_y`. Small oscillations see
//! the whole stiffness; large ones lose up to `4 a EA e_y` times their range per cycle. The law is
//! rate-independent, so `z` has a closed form over a monotonic change of strain: linear in unloading, `e_y
//! (1 - exp(-x / e_y))` in loading. Every joint stores strain and `z` of the last accepted step and follows the
//! closed form from there, without substeps; the only error is that a reversal of the motion within a step is
//! taken at the step's end.
//!
//! Source: Wen, "Method for Random Vibration of Hysteretic Systems", ASCE Journal of the Engineering
//! Mechanics Division 102 (1976).
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::exp;
use crate::model::extension::{
    Axial, Effect, Extensions, LineForceValue, Memory, MemoryDerivatives, Site, Strain,
};
use crate::model::parallel_ropes::{BACK, FRONT};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "rope_hysteresis",
        "Hysteresis of the ropes by friction between their wires",
    )
    .with_location("back_rope", Place::Dynamics)
    .size("share", Unit::One, 0.05, [0.0, 0.5])
    .shape("yield_strain", Unit::One, 3e-4, [2e-5, 5e-3])
    .with_constructor(|v| BoucWen {
        share: v.get("share"),
        yields: v.get("yield_strain"),
    })
}

#[derive(Clone, Copy, Debug)]
struct BoucWen {
    share: f64,
    /// Yield strain of the rope, at which its wires slip \[1\].
    yields: f64,
}

impl Effect for BoucWen {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        for rope in [BACK, FRONT] {
            extensions.add_axial(rope, *self);
        }
    }
}

impl BoucWen {
    /// Computes the hysteretic variable `z` after the strain has moved monotonically to `now`, and its
    /// derivatives with respect to the strain and to `z` before; that with respect to the strain before is the negative
    /// of the first.
    fn advanced(&self, [strain, z]: Memory, now: f64) -> [f64; 3] {
        let moved = now - strain;
        let sense = if moved < 0.0 { -1.0 } else { 1.0 };
        let (mut w, mut way) = (sense * z, moved.abs());
        if w < 0.0 {
            let straight = way.min(-w);
            w += straight;
            way -= straight;
            if w < 0.0 {
                return [sense * w, 1.0, 1.0];
            }
        }
        // w is zero where the sense of z has changed on the way
        let decay = exp(-way / self.yields);
        let left = (1.0 - w / self.yields) * decay;
        [sense * self.yields * (1.0 - left), left, decay]
    }
}

impl Axial for BoucWen {
    fn pull(&self, at: &Strain<'_>) -> LineForceValue {
        let stiffness = self.share * at.stiffness;
        // in the equilibrium before the run the slipping wires carry nothing
        let [z, slope, _] = at
            .memory
            .map_or([0.0; 3], |memory| self.advanced(memory, at.strain));
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
            .map_or(0.0, |memory| self.advanced(memory, at.strain)[0]);
        Some([at.strain, z])
    }

    fn memory_derivatives(&self, at: &Strain<'_>) -> Option<MemoryDerivatives> {
        let mut own = MemoryDerivatives {
            by_strain: [1.0, 0.0],
            ..MemoryDerivatives::default()
        };
        if let Some(memory) = at.memory {
            let [_, slope, kept] = self.advanced(memory, at.strain);
            let stiffness = self.share * at.stiffness;
            own.force = [-stiffness * slope, stiffness * kept];
            own.by_strain[1] = slope;
            own.by_memory = [[0.0, -slope], [0.0, kept]];
        }
        Some(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drive::DriveState;

    /// Checks that the closed form gives the same `z` for any step size and solves the differential equation.
    #[test]
    fn the_closed_form_solves_the_law_whatever_the_steps() {
        let law = BoucWen {
            share: 0.1,
            yields: 3e-4,
        };
        // strain up, down, up: turned at these places
        let turns = [0.0, 8e-4, -5e-4, 1e-4];
        let follow = |parts: u32| {
            let mut memory = [0.0, 0.0];
            for pair in turns.windows(2) {
                for k in 1..=parts {
                    let now = pair[0] + (pair[1] - pair[0]) * f64::from(k) / f64::from(parts);
                    memory = [now, law.advanced(memory, now)[0]];
                }
            }
            memory[1]
        };
        let exact = follow(1);
        assert!((follow(7) - exact).abs() < 1e-15 && (follow(300) - exact).abs() < 1e-15);
        // the equation itself, by Euler's method
        let (mut z, parts): (f64, u32) = (0.0, 200_000);
        for pair in turns.windows(2) {
            let de = (pair[1] - pair[0]) / f64::from(parts);
            for _ in 0..parts {
                let sign = if z * de > 0.0 { 1.0 } else { -1.0 };
                z += de * (1.0 - (sign + 1.0) * z.abs() / (2.0 * law.yields));
            }
        }
        assert!((z - exact).abs() < 1e-8, "{z} {exact}");
    }

    /// Checks the derivatives that concern the memory against differences in unloading, where `z` changes its sign on
    /// the way, and in loading.
    #[test]
    fn memory_derivatives_agree_with_differences() {
        let law = BoucWen {
            share: 0.1,
            yields: 3e-4,
        };
        let drive = DriveState::default();
        let at = |[strain, before, z]: [f64; 3]| Strain {
            drive: &drive,
            strain,
            rate: 0.0,
            stiffness: 1e7,
            memory: Some([before, z]),
        };
        let all = |x: [f64; 3]| {
            let [first, second] = law.next_memory(&at(x)).unwrap();
            let LineForceValue {
                spring,
                non_conservative: other,
                ..
            } = law.pull(&at(x));
            [first, second, (spring + other) * 1e-6]
        };
        for x in [[7e-4, 8e-4, 2e-4], [-5e-4, 8e-4, 2e-4], [3e-4, 0.0, 1e-4]] {
            let h = 1e-8;
            let by = |k: usize| {
                let moved = |step: f64| {
                    let mut x = x;
                    x[k] += step;
                    all(x)
                };
                let (up, down) = (moved(h), moved(-h));
                std::array::from_fn::<_, 3, _>(|row| (up[row] - down[row]) / (2.0 * h))
            };
            let found = law.memory_derivatives(&at(x)).unwrap();
            let strain = by(0);
            for (found, expected) in found.by_strain.into_iter().zip(strain) {
                assert!((found - expected).abs() < 1e-6, "{x:?}: {found} {expected}");
            }
            for k in 0..2 {
                let [first, second] = found.by_memory[k];
                for (found, expected) in [first, second, found.force[k] * 1e-6]
                    .into_iter()
                    .zip(by(k + 1))
                {
                    assert!((found - expected).abs() < 1e-6, "{x:?}: {found} {expected}");
                }
            }
        }
    }
}
