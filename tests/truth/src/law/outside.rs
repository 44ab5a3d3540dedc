//! Hidden effects that the library of the program under test does not contain.
use super::friction::{Scheduled, curve};
use super::kind::{Law, Shape, note};
use crate::draw::Draw;
use libm::{cos, exp, sqrt};
use simulation::drive::DriveState;
use simulation::effect::{Along, Dashpot, Effect, Hooks, LineForce, Site};
use simulation::math::spline::Splines;
use simulation::model::description::{AddedMode, Description};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Beam angle at the ends of the stroke \[rad\], and greatest beam angular velocity at 5 crank revolutions
/// per minute [rad/s].
const FULL: [f64; 2] = [0.55, 0.29];

/// Creates a hardening cubic spring at the saddle: `-M (theta / theta_full)^3`.
pub(super) fn cubic_spring(size: f64, _: &mut Draw, _: &mut Shape) -> Arc<dyn Law> {
    Arc::new(OnBeam {
        moment: size,
        form: Form::Cubic,
    })
}

/// Creates a drag moment on the beam, quadratic in its angular velocity: `-M w |w| / w_full^2`.
pub(super) fn drag(size: f64, _: &mut Draw, _: &mut Shape) -> Arc<dyn Law> {
    Arc::new(OnBeam {
        moment: size,
        form: Form::Drag,
    })
}

#[derive(Clone, Copy, Debug)]
enum Form {
    Cubic,
    Drag,
}

#[derive(Clone, Copy, Debug)]
struct OnBeam {
    moment: f64,
    form: Form,
}

impl Effect for OnBeam {
    fn install(&self, site: &Site<'_>, hooks: &mut Hooks) {
        hooks.on(site.layout.beam(), *self);
    }
}

impl Law for OnBeam {}

impl LineForce for OnBeam {
    fn along(&self, _: &DriveState, place: f64, rate: f64) -> Along {
        let m = self.moment;
        match self.form {
            Form::Cubic => {
                let u = place / FULL[0];
                Along {
                    spring: -m * u * u * u,
                    energy: 0.25 * m * FULL[0] * u * u * u * u,
                    by_place: -3.0 * m * u * u / FULL[0],
                    ..Along::default()
                }
            }
            Form::Drag => {
                let u = rate / FULL[1];
                Along {
                    other: -m * u * u.abs(),
                    by_rate: -2.0 * m * u.abs() / FULL[1],
                    ..Along::default()
                }
            }
        }
    }
}

/// Creates a harmonic sideways force on the crosshead, of order 2 to 5 of the crank rotation.
pub(super) fn crosshead(size: f64, draw: &mut Draw, shape: &mut Shape) -> Arc<dyn Law> {
    Arc::new(Crosshead {
        force: size,
        order: note(shape, "order_1", 2.0 + draw.index(4) as f64),
        phase: note(shape, "phase_rad", draw.between(0.0, TAU)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Crosshead {
    force: f64,
    order: f64,
    phase: f64,
}

impl Effect for Crosshead {
    fn install(&self, site: &Site<'_>, hooks: &mut Hooks) {
        let moment = self.force * site.description.rod.length;
        let moment = curve(|turn| moment * cos(self.order * turn + self.phase));
        hooks.on(site.layout.rod(), Scheduled::new(moment));
    }
}

impl Law for Crosshead {}

/// Creates a gust: a wind moment on the beam around one crank angle per revolution, as the beam leaves the
/// lee of the mast.
pub(super) fn gust(size: f64, draw: &mut Draw, shape: &mut Shape) -> Arc<dyn Law> {
    Arc::new(Gust {
        moment: size,
        at: note(shape, "turn_deg", draw.between(0.0, 360.0)),
        width: note(shape, "width_deg", draw.between(12.0, 30.0)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Gust {
    moment: f64,
    at: f64,
    width: f64,
}

impl Effect for Gust {
    fn install(&self, site: &Site<'_>, hooks: &mut Hooks) {
        let moment = curve(|turn| {
            // nearest way round the turn
            let away = (turn - self.at.to_radians() + PI).rem_euclid(TAU) - PI;
            let u = away / self.width.to_radians();
            self.moment * exp(-u * u)
        });
        hooks.on(site.layout.beam(), Scheduled::new(moment));
    }
}

impl Law for Gust {}

/// Creates loose ballast swinging on the beam: one extra head mode of 0.25 to 0.6 Hz, excited by the beam's
/// rotation.
pub(super) fn ballast(size: f64, draw: &mut Draw, shape: &mut Shape) -> Arc<dyn Law> {
    Arc::new(Ballast {
        mass: size,
        arm: note(shape, "arm_m", draw.between(2.5, 3.5)),
        frequency: note(shape, "frequency_hz", draw.between(0.25, 0.6)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Ballast {
    mass: f64,
    arm: f64,
    frequency: f64,
}

impl Effect for Ballast {
    fn describe(&self, d: &mut Description, modes: &mut usize) {
        let head = &mut d.head;
        head.keep(*modes);
        let stations = head.radial.first().map_or(2, Vec::len);
        head.add(AddedMode {
            frequency: TAU * self.frequency,
            radial: vec![0.0; stations],
            tangential: vec![0.0; stations],
            participation: [0.0, 0.0, sqrt(self.mass) * self.arm],
        });
        *modes += 1;
    }

    fn install(&self, site: &Site<'_>, hooks: &mut Hooks) {
        let d = &site.description;
        let mode = site.layout.modes - 1;
        let damping = 2.0 * (SLOSH - d.head.damping_ratio) * d.head.frequencies[mode];
        hooks.on(site.layout.mode(mode), Dashpot { damping });
    }
}

impl Law for Ballast {}

/// Creates an attached mass on a soft mount, such as a guard or a platform on brackets: one extra head mode
/// of 1.5 to 4 Hz, excited by the beam's rotation near resonance.
pub(super) fn tuned_mass(size: f64, draw: &mut Draw, shape: &mut Shape) -> Arc<dyn Law> {
    Arc::new(Ballast {
        mass: size,
        arm: note(shape, "arm_m", draw.between(2.5, 3.5)),
        frequency: note(shape, "frequency_hz", draw.between(1.5, 4.0)),
    })
}

/// Creates Coulomb friction of the carrier bar on one section of its guide.
pub(super) fn rub(size: f64, draw: &mut Draw, shape: &mut Shape) -> Arc<dyn Law> {
    Arc::new(Rub {
        force: size,
        at: note(shape, "place_1", draw.between(0.2, 0.8)),
        width: note(shape, "width_1", draw.between(0.06, 0.15)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Rub {
    force: f64,
    /// Centre of the rubbing section, as a share of the stroke.
    at: f64,
    width: f64,
}

impl Effect for Rub {
    fn install(&self, site: &Site<'_>, hooks: &mut Hooks) {
        let height = curve(|turn| site.cycle.beam(turn).value);
        let (low, high) = height
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| {
                (low.min(*y), high.max(*y))
            });
        let force = curve(|turn| {
            let beam = site.cycle.beam(turn);
            let u = ((beam.value - low) / (high - low) - self.at) / self.width;
            // Coulomb's law, softened where the rod turns round
            -self.force * exp(-u * u) * libm::tanh(beam.first / RUB)
        });
        hooks.on(site.layout.suspension(), Scheduled::new(force));
    }
}

impl Law for Rub {}

/// Rate of beam angle per crank angle at which the regularised friction nearly reaches its full value.
const RUB: f64 = 0.01;

/// Creates an eccentric gear wheel: a harmonic advance of the crank angle, of order 3 to 7.
pub(super) fn gear(size: f64, draw: &mut Draw, shape: &mut Shape) -> Arc<dyn Law> {
    Arc::new(Gear {
        angle: size,
        order: note(shape, "order_1", 3.0 + draw.index(5) as f64),
        phase: note(shape, "phase_rad", draw.between(0.0, TAU)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Gear {
    /// Amplitude of the crank angle error \[deg\].
    angle: f64,
    order: f64,
    phase: f64,
}

impl Effect for Gear {
    fn install(&self, _: &Site<'_>, hooks: &mut Hooks) {
        let angle = self.angle.to_radians();
        let ahead = curve(|turn| angle * (cos(self.order * turn + self.phase) - cos(self.phase)));
        let step = TAU / ahead.len() as f64;
        hooks.add_warp(Splines::periodic(0.0, step, &[ahead]));
    }
}

impl Law for Gear {}

/// Damping ratio of the mode of the loose ballast or attached mass.
const SLOSH: f64 = 0.08;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn laws_on_the_beam_have_the_stated_size_and_their_own_derivatives() {
        let drive = DriveState::default();
        for form in [Form::Cubic, Form::Drag] {
            let law = OnBeam {
                moment: 3000.0,
                form,
            };
            let full = law.along(&drive, FULL[0], FULL[1]);
            assert!((full.spring + full.other + 3000.0).abs() < 1e-9);
            for (place, rate) in [(0.3, -0.2), (-0.5, 0.1)] {
                let h = 1e-6;
                let at = |dp: f64, dr: f64| law.along(&drive, place + dp, rate + dr);
                let sum = |a: Along| a.spring + a.other;
                let own = at(0.0, 0.0);
                let by_place = (sum(at(h, 0.0)) - sum(at(-h, 0.0))) / (2.0 * h);
                let by_rate = (sum(at(0.0, h)) - sum(at(0.0, -h))) / (2.0 * h);
                let by_energy = (at(h, 0.0).energy - at(-h, 0.0).energy) / (2.0 * h);
                assert!((by_place - own.by_place).abs() < 1e-2);
                assert!((by_rate - own.by_rate).abs() < 1e-2);
                assert!((by_energy + own.spring).abs() < 1e-2);
            }
        }
    }
}
