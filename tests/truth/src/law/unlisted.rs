//! Hidden effects that the library of the program under test does not contain.
use super::friction::{PrescribedForce, curve};
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use libm::{cos, exp, sqrt};
use simulation::drive::DriveState;
use simulation::effect::{Dashpot, Effect, Extensions, LineForce, LineForceValue, Site};
use simulation::math::spline::Splines;
use simulation::model::description::{AddedMode, Description};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Beam angle at the ends of the stroke \[rad\], and greatest beam angular velocity at 5 crank revolutions
/// per minute [rad/s].
const BEAM_AMPLITUDES: [f64; 2] = [0.55, 0.29];

/// Creates a hardening cubic spring at the saddle: `-M (theta / theta_full)^3`.
pub(super) fn cubic_spring(
    size: f64,
    _: &mut RandomStream,
    _: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(OnBeam {
        moment: size,
        form: Form::Cubic,
    })
}

/// Creates a drag moment on the beam, quadratic in its angular velocity: `-M w |w| / w_full^2`.
pub(super) fn drag(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
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
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_line_force(site.layout.beam(), *self);
    }
}

impl HiddenEffect for OnBeam {}

impl LineForce for OnBeam {
    fn along(&self, _: &DriveState, place: f64, rate: f64) -> LineForceValue {
        let m = self.moment;
        match self.form {
            Form::Cubic => {
                let u = place / BEAM_AMPLITUDES[0];
                LineForceValue {
                    spring: -m * u * u * u,
                    energy: 0.25 * m * BEAM_AMPLITUDES[0] * u * u * u * u,
                    by_place: -3.0 * m * u * u / BEAM_AMPLITUDES[0],
                    ..LineForceValue::default()
                }
            }
            Form::Drag => {
                let u = rate / BEAM_AMPLITUDES[1];
                LineForceValue {
                    non_conservative: -m * u * u.abs(),
                    by_rate: -2.0 * m * u.abs() / BEAM_AMPLITUDES[1],
                    ..LineForceValue::default()
                }
            }
        }
    }
}

/// Creates a harmonic sideways force on the crosshead, of order 2 to 5 of the crank rotation.
pub(super) fn crosshead(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Crosshead {
        force: size,
        order: record_shape(shape, "order_1", 2.0 + draw.index(4) as f64),
        phase: record_shape(shape, "phase_rad", draw.between(0.0, TAU)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Crosshead {
    force: f64,
    order: f64,
    phase: f64,
}

impl Effect for Crosshead {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let moment = self.force * site.description.rod.length;
        let moment = curve(|turn| moment * cos(self.order * turn + self.phase));
        extensions.add_line_force(site.layout.rod(), PrescribedForce::new(moment));
    }
}

impl HiddenEffect for Crosshead {}

/// Creates a gust: a wind moment on the beam around one crank angle per revolution, as the beam leaves the
/// lee of the mast.
pub(super) fn gust(size: f64, draw: &mut RandomStream, shape: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Gust {
        moment: size,
        at: record_shape(shape, "turn_deg", draw.between(0.0, 360.0)),
        width: record_shape(shape, "width_deg", draw.between(12.0, 30.0)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Gust {
    moment: f64,
    at: f64,
    width: f64,
}

impl Effect for Gust {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let moment = curve(|turn| {
            // nearest way round the turn
            let away = (turn - self.at.to_radians() + PI).rem_euclid(TAU) - PI;
            let u = away / self.width.to_radians();
            self.moment * exp(-u * u)
        });
        extensions.add_line_force(site.layout.beam(), PrescribedForce::new(moment));
    }
}

impl HiddenEffect for Gust {}

/// Creates loose ballast swinging on the beam: one extra head mode of 0.25 to 0.6 Hz, excited by the beam's
/// rotation.
pub(super) fn ballast(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Ballast {
        mass: size,
        arm: record_shape(shape, "arm_m", draw.between(2.5, 3.5)),
        frequency: record_shape(shape, "frequency_hz", draw.between(0.25, 0.6)),
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

    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let d = &site.description;
        let mode = site.layout.modes - 1;
        let damping =
            2.0 * (BALLAST_DAMPING_RATIO - d.head.damping_ratio) * d.head.frequencies[mode];
        extensions.add_line_force(site.layout.mode(mode), Dashpot { damping });
    }
}

impl HiddenEffect for Ballast {}

/// Creates an attached mass on a soft mount, such as a guard or a platform on brackets: one extra head mode
/// of 1.5 to 4 Hz, excited by the beam's rotation near resonance.
pub(super) fn tuned_mass(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Ballast {
        mass: size,
        arm: record_shape(shape, "arm_m", draw.between(2.5, 3.5)),
        frequency: record_shape(shape, "frequency_hz", draw.between(1.5, 4.0)),
    })
}

/// Creates Coulomb friction of the carrier bar on one section of its guide.
pub(super) fn rub(size: f64, draw: &mut RandomStream, shape: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Rub {
        force: size,
        at: record_shape(shape, "place_1", draw.between(0.2, 0.8)),
        width: record_shape(shape, "width_1", draw.between(0.06, 0.15)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Rub {
    force: f64,
    /// Centre of the guide's rubbing section, as a share of the stroke.
    at: f64,
    width: f64,
}

impl Effect for Rub {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
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
            -self.force * exp(-u * u) * libm::tanh(beam.first / RUB_REGULARISATION)
        });
        extensions.add_line_force(site.layout.suspension(), PrescribedForce::new(force));
    }
}

impl HiddenEffect for Rub {}

/// Rate of beam angle per crank angle above which the smoothed friction has nearly its full value.
const RUB_REGULARISATION: f64 = 0.01;

/// Creates an eccentric gear wheel: a harmonic advance of the crank angle, of order 3 to 7.
pub(super) fn gear(size: f64, draw: &mut RandomStream, shape: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Gear {
        angle: size,
        order: record_shape(shape, "order_1", 3.0 + draw.index(5) as f64),
        phase: record_shape(shape, "phase_rad", draw.between(0.0, TAU)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Gear {
    /// Amplitude of the crank angle error that the gear wheel causes \[deg\].
    angle: f64,
    order: f64,
    phase: f64,
}

impl Effect for Gear {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        let angle = self.angle.to_radians();
        let ahead = curve(|turn| angle * (cos(self.order * turn + self.phase) - cos(self.phase)));
        let step = TAU / ahead.len() as f64;
        extensions.add_warp(Splines::periodic(0.0, step, &[ahead]));
    }
}

impl HiddenEffect for Gear {}

/// Damping ratio of the mode of the loose ballast or attached mass.
const BALLAST_DAMPING_RATIO: f64 = 0.08;

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
            let full = law.along(&drive, BEAM_AMPLITUDES[0], BEAM_AMPLITUDES[1]);
            assert!((full.spring + full.non_conservative + 3000.0).abs() < 1e-9);
            for (place, rate) in [(0.3, -0.2), (-0.5, 0.1)] {
                let h = 1e-6;
                let at = |dp: f64, dr: f64| law.along(&drive, place + dp, rate + dr);
                let sum = |a: LineForceValue| a.spring + a.non_conservative;
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
