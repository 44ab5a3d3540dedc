//! Hidden effects of the load: a card that is late, lagged, smoothed or truncated, an unbalanced beam, and
//! other pump conditions.
use super::kind::{HiddenEffect, Shape, record_shape};
use crate::draw::RandomStream;
use libm::{exp, sin};
use simulation::drive::DriveState;
use simulation::effect::{Cycle, Effect, Extensions, LineForce, LineForceValue, Site};
use simulation::math::harmonics::filter;
use simulation::model::description::Description;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Creates a late load card: the true load precedes the delivered card by a crank angle.
pub(super) fn late_card(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(LateCard { time: size })
}

#[derive(Clone, Copy, Debug)]
struct LateCard {
    time: f64,
}

impl Effect for LateCard {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let n = d.card.len();
        let late = self.time * d.crank.speed / TAU * n as f64;
        let card = d.card.clone();
        for (i, load) in d.card.iter_mut().enumerate() {
            let place = (i as f64 + late).rem_euclid(n as f64);
            let share = place.fract();
            let at = |offset: usize| card[(whole(place) + offset) % n];
            *load = at(0) * (1.0 - share) + at(1) * share;
        }
    }
}

impl HiddenEffect for LateCard {}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a place in a table, not negative"
)]
fn whole(place: f64) -> usize {
    place as usize
}

/// Creates an unbalanced beam with a correct load cell.
pub(super) fn unbalance(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Unbalance { force: size })
}

#[derive(Clone, Copy, Debug)]
struct Unbalance {
    /// Unbalance as a force at the front head \[N\].
    force: f64,
}

impl Effect for Unbalance {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.beam_gravity_moment += self.force * d.front_arc.radius;
    }
}

impl HiddenEffect for Unbalance {}

/// Creates a logger with a two-pole filter: the delivered card is the load, smoothed and delayed.
pub(super) fn slow_logger(size: f64, _: &mut RandomStream, _: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(SlowLogger { lag: size })
}

#[derive(Clone, Copy, Debug)]
struct SlowLogger {
    /// Delay of slow load changes: sum of both poles' time constants \[s\].
    lag: f64,
}

impl Effect for SlowLogger {}

impl HiddenEffect for SlowLogger {
    fn distort_card(&self, card: &mut Vec<f64>, speed: f64) {
        *card = filter(card, u32::MAX, |harmonic| {
            let x = 0.5 * self.lag * speed * f64::from(harmonic);
            // 1 / (1 + i x)^2
            let size = 1.0 / ((1.0 + x * x) * (1.0 + x * x));
            [(1.0 - x * x) * size, -2.0 * x * size]
        });
    }
}

/// Creates a load card smoothed by a moving average over the crank angle.
pub(super) fn moving_average(
    size: f64,
    _: &mut RandomStream,
    _: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(MovingAverage { window: size })
}

#[derive(Clone, Copy, Debug)]
struct MovingAverage {
    /// Width of the averaging window \[deg\].
    window: f64,
}

impl Effect for MovingAverage {}

impl HiddenEffect for MovingAverage {
    fn distort_card(&self, card: &mut Vec<f64>, _: f64) {
        let n = card.len();
        let reach = whole((0.5 * self.window / 360.0 * n as f64).round()).min(n / 2);
        let own = card.clone();
        for (i, load) in card.iter_mut().enumerate() {
            let window = (0..=2 * reach).map(|k| own[(i + n + k - reach) % n]);
            *load = window.sum::<f64>() / (2 * reach + 1) as f64;
        }
    }
}

/// Creates a load card truncated to its mean and its first `size` harmonics.
pub(super) fn truncated_card(
    size: f64,
    _: &mut RandomStream,
    _: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Cut { harmonics: size })
}

#[derive(Clone, Copy, Debug)]
struct Cut {
    harmonics: f64,
}

impl Effect for Cut {}

impl HiddenEffect for Cut {
    fn distort_card(&self, card: &mut Vec<f64>, _: f64) {
        *card = filter(card, u32::MAX, |harmonic| {
            [
                f64::from(u8::from(f64::from(harmonic) <= self.harmonics)),
                0.0,
            ]
        });
    }
}

/// Creates fluid pound of an incompletely filled pump: the plunger carries its load down until it meets the
/// liquid, the load then decays exponentially, and the rods oscillate.
pub(super) fn fluid_pound(
    size: f64,
    draw: &mut RandomStream,
    shape: &mut Shape,
) -> Arc<dyn HiddenEffect> {
    Arc::new(Pound {
        held: size,
        fillage: record_shape(shape, "fillage_1", draw.between(0.7, 0.92)),
        fall: record_shape(shape, "fall_deg", draw.between(2.0, 4.0)),
        blow: size * record_shape(shape, "blow_n", draw.between(1000.0, 4000.0)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Pound {
    held: f64,
    fillage: f64,
    fall: f64,
    blow: f64,
}

/// Natural frequency of the pump rods \[Hz\] and decay time of their oscillation \[s\].
const RODS: (f64, f64) = (0.739, 2.0);

impl Effect for Pound {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        let Ok(cycle) = Cycle::of(d) else { return };
        let (top, meets) = (
            cycle.turn_at_descent(0.0),
            cycle.turn_at_descent(1.0 - self.fillage),
        );
        let n = d.card.len();
        let step = TAU / n as f64;
        let place = |turn: f64| whole((turn / step).round()) % n;
        let full = d.card[place(top)];
        let period = TAU / d.crank.speed;
        for (i, load) in d.card.iter_mut().enumerate() {
            let turn = step * i as f64;
            if turn > top {
                let held = if turn < meets {
                    1.0
                } else {
                    exp(-(turn - meets) / self.fall.to_radians())
                };
                *load += self.held * held * (full - *load);
            }
            for earlier in 0..3 {
                let t = (turn - meets) / d.crank.speed + period * f64::from(earlier);
                if t > 0.0 {
                    *load -= self.blow * sin(TAU * RODS.0 * t) * exp(-t / RODS.1);
                }
            }
        }
    }
}

impl HiddenEffect for Pound {}

/// Creates the response of the rod string to motion that the card does not include: an impedance that grows
/// with speed, and a soft spring for reflections from the lower end.
pub(super) fn rods(size: f64, draw: &mut RandomStream, shape: &mut Shape) -> Arc<dyn HiddenEffect> {
    Arc::new(Rods {
        impedance: size,
        spring: record_shape(shape, "spring_n_m", draw.log_between(2e3, 1e4)),
    })
}

#[derive(Clone, Copy, Debug)]
struct Rods {
    impedance: f64,
    spring: f64,
}

impl Effect for Rods {
    fn install(&self, site: &Site<'_>, extensions: &mut Extensions) {
        let answer = RodResponse {
            law: *self,
            arm: site.description.front_arc.radius,
            height: site.lowest_suspension,
            lowest: site.bottom.beam,
            cycle: site.cycle.clone(),
        };
        extensions.add_line_force(site.layout.suspension(), answer);
    }
}

impl HiddenEffect for Rods {}

#[derive(Clone, Debug)]
struct RodResponse {
    law: Rods,
    arm: f64,
    height: f64,
    lowest: f64,
    cycle: Cycle,
}

/// Deviation of the suspension's speed from the regular one at which the rods' impedance is a quarter larger
/// [m/s].
const FAST: f64 = 0.4;

impl LineForce for RodResponse {
    fn along(&self, drive: &DriveState, place: f64, rate: f64) -> LineForceValue {
        let beam = self.cycle.beam(drive.turn);
        let turning = self.cycle.crank().sense * drive.pin_rate;
        let beyond = place - self.height - self.arm * (beam.value - self.lowest);
        let faster = rate - self.arm * beam.first * turning;
        let growth = 0.25 * faster.abs() / FAST;
        LineForceValue {
            spring: -self.law.spring * beyond,
            energy: 0.5 * self.law.spring * beyond * beyond,
            non_conservative: -self.law.impedance * faster * (1.0 + growth),
            by_place: -self.law.spring,
            by_rate: -self.law.impedance * (1.0 + 2.0 * growth),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use libm::cos;

    fn wave(harmonic: f64, phase: f64) -> Vec<f64> {
        (0..720)
            .map(|i| cos(harmonic * TAU * f64::from(i) / 720.0 - phase))
            .collect()
    }

    #[test]
    fn a_two_pole_filter_delays_and_weakens() {
        let speed = TAU / 12.0;
        let mut card = wave(5.0, 0.0);
        SlowLogger { lag: 0.2 }.distort_card(&mut card, speed);
        let x: f64 = 0.1 * speed * 5.0;
        let expected = wave(5.0, 2.0 * libm::atan(x));
        for (found, expected) in card.iter().zip(expected) {
            assert!((found - expected / (1.0 + x * x)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_late_card_and_a_smoothed_one() {
        let mut d = simulation::reference::description();
        let plain = d.card.clone();
        // by one sample of the table
        let step = TAU / plain.len() as f64 / d.crank.speed;
        LateCard { time: step }.describe(&mut d, &mut 2);
        assert!((0..plain.len()).all(|i| (d.card[i] - plain[(i + 1) % plain.len()]).abs() < 1e-6));
        let mut card = wave(24.0, 0.3);
        MovingAverage { window: 14.5 }.distort_card(&mut card, 0.5);
        assert!(
            card.iter().all(|load| load.abs() < 0.05),
            "a wave of 15 deg averages out"
        );
    }

    #[test]
    fn a_pound_holds_the_load_and_then_drops_it() {
        let mut d = simulation::reference::description();
        d.card = (0..720)
            .map(|i| if i < 400 { 70e3 } else { 40e3 })
            .collect();
        let pound = Pound {
            held: 1.0,
            fillage: 0.8,
            fall: 3.0,
            blow: 0.0,
        };
        pound.describe(&mut d, &mut 2);
        let cycle = Cycle::of(&d).unwrap();
        let meets = whole(cycle.turn_at_descent(0.2) / TAU * 720.0);
        assert!(d.card[meets - 2] > 69e3 && d.card[meets + 40] < 42e3);
    }
}
