//! Prescribed motion of the crank and load at the suspension point.
//!
//! `Machine::drive_state` computes the [`DriveState`] from the [`Drive`].
use nalgebra::Vector2;

type V2 = Vector2<f64>;

/// Motion of the crank: start-up from rest to a constant full speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Crank turn angle at rest, from bottom dead centre \[rad\].
    pub start: f64,
    /// Duration of the start-up to full speed \[s\].
    pub ramp: f64,
    /// Full angular speed [rad/s].
    pub speed: f64,
}

/// Crank motion and load at one instant.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveState {
    /// Time since the start from rest \[s\].
    pub time: f64,
    /// Crank turn angle from bottom dead centre \[rad\].
    pub turn: f64,
    /// Position of the crank pin in the world frame W \[m\], with its velocity and acceleration.
    pub pin: [V2; 3],
    /// Angle of the crank pin about the shaft \[rad\].
    pub pin_angle: f64,
    /// Signed rate of the pin angle [rad/s].
    pub pin_rate: f64,
    /// Load at the suspension point, positive downwards \[N\].
    pub load: f64,
}

impl Drive {
    /// Returns the crank's turn angle, its rate and its acceleration at time `t`; the acceleration is
    /// continuous over the start-up.
    pub fn turn(&self, t: f64) -> [f64; 3] {
        if t >= self.ramp {
            return [
                self.start + self.speed * (t - 0.5 * self.ramp),
                self.speed,
                0.0,
            ];
        }
        let u = (t / self.ramp).max(0.0);
        let travelled = u * u * u * u * (2.5 + u * (u - 3.0));
        let rate = u * u * u * (10.0 + u * (6.0 * u - 15.0));
        let slope = 30.0 * u * u * (1.0 - u) * (1.0 - u);
        [
            self.start + self.speed * self.ramp * travelled,
            self.speed * rate,
            self.speed * slope / self.ramp,
        ]
    }

    /// Returns the time at which the crank, running at full speed, reaches a turn angle \[s\].
    pub fn time_at(&self, turn: f64) -> f64 {
        (turn - self.start) / self.speed + 0.5 * self.ramp
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramp_is_smooth_and_meets_full_speed() {
        let drive = Drive {
            start: -1.0,
            ramp: 1.5,
            speed: 0.5,
        };
        let h = 1e-5;
        for t in [0.2, 0.9, 1.4999, 1.5, 1.6, 4.0] {
            let [_, rate, acceleration] = drive.turn(t);
            let by_turn = (drive.turn(t + h)[0] - drive.turn(t - h)[0]) / (2.0 * h);
            let by_rate = (drive.turn(t + h)[1] - drive.turn(t - h)[1]) / (2.0 * h);
            assert!(
                (by_turn - rate).abs() < 1e-8 && (by_rate - acceleration).abs() < 1e-6,
                "{t}"
            );
        }
        let [turn, rate, _] = drive.turn(0.0);
        assert_eq!(
            [turn, rate].map(f64::to_bits),
            [-1.0, 0.0_f64].map(f64::to_bits)
        );
        assert!((drive.turn(drive.time_at(3.0))[0] - 3.0).abs() < 1e-14);
    }
}
