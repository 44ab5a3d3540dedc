//! Nuisance parameters of every test: small errors of instruments, saddle bearing and beam balance, constant
//! over the test and equal in all conditions.
//!
//! [`Tolerance`] holds their standard deviations, as a data sheet states them; how a diagnosis treats them is
//! not modelled here.
use super::drive::late_index;
use super::friction::sliding;
use super::gauge::delay;
use super::kind::{HiddenEffect, Shape};
use crate::draw::RandomStream;
use crate::turn::Turn;
use serde::{Deserialize, Serialize};
use simulation::effect::Effect;
use simulation::model::description::Description;
use std::sync::Arc;

/// Standard deviations of the nuisance parameters; the serialised keys are those of the `[tolerance]` table
/// of a data sheet.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tolerance {
    /// Standard deviation of the relative gain error of each strain gauge.
    pub gauge_factor: f64,
    /// Standard deviation of the position of the crank's index mark \[deg\].
    pub index_deg: f64,
    /// Standard deviation of the relative error of the card's load.
    pub load_cell: f64,
    /// Scale of the delay of the gauge amplifiers, drawn as a half-normal value \[s\].
    pub amplifier_lag_s: f64,
    /// Standard deviation of the relative gain error of the position sensor.
    pub position: f64,
    /// Standard deviation of the relative gain error of the torque sensor.
    pub torque: f64,
    /// Scale of the friction moment of the saddle bearing, drawn as a half-normal value [N m].
    pub bearing_friction_nm: f64,
    /// Standard deviation of the error in the moment of the beam's weight about the pivot [N m].
    pub balance_nm: f64,
}

impl Tolerance {
    /// Standard deviations that the data sheets of the case's own records state.
    pub const USUAL: Self = Self {
        gauge_factor: 0.005,
        index_deg: 0.06,
        load_cell: 0.003,
        amplifier_lag_s: 0.002,
        position: 0.002,
        torque: 0.005,
        bearing_friction_nm: 50.0,
        balance_nm: 200.0,
    };

    /// Returns all tolerances multiplied by `factor`.
    #[must_use]
    pub const fn times(self, factor: f64) -> Self {
        Self {
            gauge_factor: factor * self.gauge_factor,
            index_deg: factor * self.index_deg,
            load_cell: factor * self.load_cell,
            amplifier_lag_s: factor * self.amplifier_lag_s,
            position: factor * self.position,
            torque: factor * self.torque,
            bearing_friction_nm: factor * self.bearing_friction_nm,
            balance_nm: factor * self.balance_nm,
        }
    }
}

/// Values of the nuisance parameters (instrument, bearing and balance errors) drawn for one test.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Nuisances {
    /// Relative gain error of each gauge.
    pub gauge_factor: [f64; 4],
    /// Delay of the recorded crank angle \[deg\].
    pub index_deg: f64,
    /// Relative excess of the load in the delivered card over the true load.
    pub load_cell: f64,
    /// Delay of the gauge signals in the amplifiers \[s\].
    pub amplifier_lag_s: f64,
    /// Relative gain error of the position sensor.
    pub position: f64,
    /// Relative gain error of the torque sensor.
    pub torque: f64,
    /// Friction moment of the saddle bearing [N m].
    pub bearing_friction_nm: f64,
    /// Additional moment of the beam's weight about the pivot, by which the beam is out of balance [N m].
    pub balance_nm: f64,
}

impl Nuisances {
    /// Draws the nuisance parameters of a test; those that a hidden effect of the same kind replaces are
    /// zero.
    pub fn draw(tolerance: &Tolerance, draw: &mut RandomStream, hidden: &[&str]) -> Self {
        let mut drawn = Self {
            gauge_factor: [0.0; 4].map(|_: f64| tolerance.gauge_factor * draw.normal()),
            index_deg: tolerance.index_deg * draw.normal(),
            load_cell: tolerance.load_cell * draw.normal(),
            amplifier_lag_s: tolerance.amplifier_lag_s * draw.normal().abs(),
            position: tolerance.position * draw.normal(),
            torque: tolerance.torque * draw.normal(),
            bearing_friction_nm: tolerance.bearing_friction_nm * draw.normal().abs(),
            balance_nm: tolerance.balance_nm * draw.normal(),
        };
        for id in hidden {
            match *id {
                "gauge_gain" => drawn.gauge_factor = [0.0; 4],
                "crank_angle_offset" => drawn.index_deg = 0.0,
                "amplifier_lag" => drawn.amplifier_lag_s = 0.0,
                "pivot_friction" => drawn.bearing_friction_nm = 0.0,
                _ => {}
            }
        }
        drawn
    }

    /// Returns the nuisance parameters in the form of hidden effects that act on the machine and its
    /// instruments.
    pub fn laws(&self) -> [Arc<dyn HiddenEffect>; 4] {
        let none = (&mut RandomStream::new(0, "nothing"), &mut Shape::new());
        [
            Arc::new(self.clone()),
            sliding(self.bearing_friction_nm),
            delay(self.amplifier_lag_s, none.0, none.1),
            late_index(self.index_deg, none.0, none.1),
        ]
    }
}

impl Effect for Nuisances {
    fn describe(&self, d: &mut Description, _: &mut usize) {
        d.beam_gravity_moment += self.balance_nm;
    }
}

impl HiddenEffect for Nuisances {
    fn distort_card(&self, card: &mut Vec<f64>, _: f64) {
        for load in card {
            *load *= 1.0 + self.load_cell;
        }
    }

    fn distort_readings(&self, turn: &mut Turn) {
        let gauges = turn.stress.iter_mut().zip(self.gauge_factor);
        let others = [
            (&mut turn.position, self.position),
            (&mut turn.torque, self.torque),
        ];
        for (curve, share) in gauges.chain(others) {
            for value in curve {
                *value *= 1.0 + share;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_are_as_good_as_stated_and_leave_an_effect_of_their_kind_alone() {
        let drawn = |seed: u64, hidden: &[&str]| {
            let mut draw = RandomStream::new(seed, "nuisances");
            Nuisances::draw(&Tolerance::USUAL, &mut draw, hidden)
        };
        let many: Vec<Nuisances> = (0..2000).map(|seed| drawn(seed, &[])).collect();
        let rms = |of: &dyn Fn(&Nuisances) -> f64| {
            let squares = many.iter().map(|one| of(one) * of(one));
            (squares.sum::<f64>() / many.len() as f64).sqrt()
        };
        assert!((rms(&|one| one.gauge_factor[2]) / 0.005 - 1.0).abs() < 0.05);
        assert!((rms(&|one| one.balance_nm) / 200.0 - 1.0).abs() < 0.05);
        assert!((rms(&|one| one.amplifier_lag_s) / 0.002 - 1.0).abs() < 0.05);
        assert!(many.iter().all(|one| one.bearing_friction_nm >= 0.0));
        let beside = drawn(7, &["pivot_friction"]);
        assert!(beside.bearing_friction_nm.abs() < 1e-12);
        assert!((beside.balance_nm - many[7].balance_nm).abs() < 1e-12);
        let none = Tolerance::USUAL.times(0.0);
        let none = Nuisances::draw(&none, &mut RandomStream::new(7, "nuisances"), &[]);
        assert!(none.balance_nm.abs() < 1e-12 && none.gauge_factor[0].abs() < 1e-12);
    }
}
