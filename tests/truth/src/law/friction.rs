//! Hidden effects of dry friction: hard sign change, Stribeck peak, and presliding over a distance (Dahl).
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use libm::exp;
use simulation::drive::DriveState;
use simulation::effect::{Effect, Extensions, LineForce, LineForceValue, Site};
use simulation::math::spline::Splines;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Number of samples of a friction curve over one crank turn.
const NODES: usize = 1440;

/// Creates the friction of a grease-starved plain bearing: `M = mu r N (1 + p exp(-|w| / w_s)) sgn(w)` with
/// the bearing load `N`; the sign function is linear only below the speed [`HARD`].
pub(super) fn plain_bearing(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Bearing {
        moment: size,
        peak: record_shape(shape, "stribeck_peak_1", draw.between(0.1, 0.4)),
        speed: record_shape(shape, "stribeck_speed_rad_s", draw.log_between(0.005, 0.03)),
    })
}

/// Creates the friction of a greased bearing: Coulomb friction without a Stribeck peak.
pub(super) fn sliding(moment: f64) -> Arc<dyn HiddenEffect> {
    Arc::new(Bearing {
        moment,
        peak: 0.0,
        speed: 0.01,
    })
}

#[derive(Clone, Copy, Debug)]
struct Bearing {
    /// Friction moment of the bearing at its mean load [N m].
    moment: f64,
    peak: f64,
    speed: f64,
}

/// Angular velocity of the bearing below which the sign function of its friction is replaced by a line
/// [rad/s].
const HARD: f64 = 3e-4;

impl Effect for Bearing {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let d = &site.description;
        let weight = 2.0 * d.suspension_mass * d.gravity;
        let card = Splines::periodic(
            0.0,
            TAU / d.card.len() as f64,
            std::slice::from_ref(&d.card),
        );
        let load = curve(|turn| site.cycle.tension(turn) + card.value(turn, 0) + weight);
        let mean = load.iter().sum::<f64>() / load.len() as f64;
        let share: Vec<f64> = load.iter().map(|load| load / mean).collect();
        let rubbing = BearingFriction {
            law: *self,
            share: Splines::periodic(0.0, TAU / NODES as f64, &[share]),
        };
        extensions.add_line_force(site.layout.beam(), rubbing);
    }
}

impl HiddenEffect for Bearing {}

#[derive(Clone, Debug)]
struct BearingFriction {
    law: Bearing,
    /// Load on the bearing divided by its mean, as a function of the crank turn \[1\].
    share: Splines,
}

impl LineForce for BearingFriction {
    fn along(&self, drive: &DriveState, _: f64, rate: f64) -> LineForceValue {
        let size = self.law.moment * self.share.value(drive.turn, 0);
        let rise = self.law.peak * exp(-rate.abs() / self.law.speed);
        if rate.abs() < HARD {
            // the peak is taken as flat here: it falls by some per cent
            let slope = size * (1.0 + self.law.peak) / HARD;
            return LineForceValue {
                non_conservative: -slope * rate,
                by_rate: -slope,
                ..LineForceValue::default()
            };
        }
        LineForceValue {
            non_conservative: -size * (1.0 + rise) * rate.signum(),
            by_rate: size * rise / self.law.speed,
            ..LineForceValue::default()
        }
    }
}

/// Creates the friction of a stuffing box packing with presliding (Dahl): after a reversal the force changes
/// with the distance as `F_s (1 - 2 exp(-x / x_d))`, and differs between upstroke and downstroke.
pub(super) fn packing(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Packing {
        force: size,
        sliding_distance: record_shape(shape, "way_m", draw.log_between(0.004, 0.02)),
        upstroke_excess: record_shape(shape, "upstroke_excess_1", draw.between(-0.1, 0.1)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Packing {
    force: f64,
    sliding_distance: f64,
    upstroke_excess: f64,
}

impl Effect for Packing {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let arm = site.description.front_arc.radius;
        let side = dahl_state(
            &curve(|turn| arm * site.cycle.beam(turn).value),
            self.sliding_distance,
        );
        let force = side
            .iter()
            .map(|side| -self.force * (side + self.upstroke_excess * side.abs()));
        extensions.add_line_force(
            site.layout.suspension(),
            PrescribedForce::new(force.collect()),
        );
    }
}

impl HiddenEffect for Packing {}

/// Creates the loss of a rope that winds on and off its head: a share of the tension plus a constant, reached
/// gradually over an angle of winding after a reversal.
pub(super) fn winding(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Winding {
        loss: size,
        constant: record_shape(shape, "constant_share_1", draw.between(0.1, 0.4)),
        way: record_shape(shape, "way_rad", draw.log_between(0.005, 0.02)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Winding {
    loss: f64,
    constant: f64,
    way: f64,
}

impl Effect for Winding {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let cycle = site.cycle;
        let tension = curve(|turn| cycle.tension(turn));
        let mean = tension.iter().sum::<f64>() / tension.len() as f64;
        let side = dahl_state(&curve(|turn| cycle.tangent(turn).value), self.way);
        let arm = curve(|turn| cycle.arm(turn));
        let moment = (0..NODES).map(|i| {
            let pull = (1.0 - self.constant) * tension[i] + self.constant * mean;
            self.loss * pull * arm[i] * side[i]
        });
        extensions.add_line_force(site.layout.beam(), PrescribedForce::new(moment.collect()));
    }
}

impl HiddenEffect for Winding {}

/// Force or moment prescribed as a function of the crank angle.
#[derive(Clone, Debug)]
pub(super) struct PrescribedForce {
    force: Splines,
}

impl PrescribedForce {
    /// Creates the force from samples at equally spaced angles of the turn, as returned by [`curve`].
    pub(super) fn new(force: Vec<f64>) -> Self {
        Self {
            force: Splines::periodic(0.0, TAU / force.len() as f64, &[force]),
        }
    }
}

impl LineForce for PrescribedForce {
    fn along(&self, drive: &DriveState, _: f64, _: f64) -> LineForceValue {
        LineForceValue {
            non_conservative: self.force.value(drive.turn, 0),
            ..LineForceValue::default()
        }
    }
}

/// Samples a function at equally spaced angles of the turn.
pub(super) fn curve(at: impl Fn(f64) -> f64) -> Vec<f64> {
    (0..NODES)
        .map(|i| at(TAU * i as f64 / NODES as f64))
        .collect()
}

/// Computes the Dahl friction state between -1 and 1 along a periodic motion: `dz = (1 - z sgn dx) dx / way`.
fn dahl_state(motion: &[f64], way: f64) -> Vec<f64> {
    let n = motion.len();
    let mut side = vec![0.0; n];
    let mut z: f64 = 0.0;
    for k in 1..=2 * n {
        let moved = motion[k % n] - motion[(k - 1) % n];
        let end = if moved < 0.0 { -1.0 } else { 1.0 };
        z = end + (z - end) * exp(-moved.abs() / way);
        side[k % n] = z;
    }
    side
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dahl_follows_its_equation_and_repeats() {
        let motion = curve(|turn| 0.2 * libm::cos(turn));
        let way = 0.01;
        let side = dahl_state(&motion, way);
        // on the way down from the top: z = -1 + (z_0 + 1) exp(-x / way), with z_0 = 1 at the top
        let x = motion[0] - motion[300];
        assert!((side[300] - (-1.0 + 2.0 * exp(-x / way))).abs() < 1e-6);
        assert!(side.iter().all(|side| side.abs() <= 1.0));
        assert!((side[0] - 1.0).abs() < 1e-6, "it has come up all the way");
    }

    #[test]
    fn a_bearing_rubs_against_its_motion_whatever_its_speed() {
        let law = Bearing {
            moment: 1500.0,
            peak: 0.3,
            speed: 0.02,
        };
        let rubbing = BearingFriction {
            law,
            share: Splines::periodic(0.0, 1.0, &[vec![1.0; 8]]),
        };
        let drive = DriveState::default();
        for rate in [-0.3, -0.02, -1e-4, 1e-4, 0.02, 0.3] {
            let along = rubbing.along(&drive, 0.0, rate);
            assert!(along.non_conservative * rate < 0.0);
            let h = 1e-9;
            let slope = (rubbing.along(&drive, 0.0, rate + h).non_conservative
                - rubbing.along(&drive, 0.0, rate - h).non_conservative)
                / (2.0 * h);
            assert!((slope - along.by_rate).abs() <= 1e-3 * slope.abs().max(1.0));
        }
        let slow = rubbing.along(&drive, 0.0, 0.001).non_conservative.abs();
        let fast = rubbing.along(&drive, 0.0, 0.3).non_conservative.abs();
        assert!(slow > 1.2 * fast, "it falls as the bearing floats");
    }
}
