//! Mechanism of a machine with inextensible ropes, and the machine's drive over time.
use crate::drive::{Drive, DriveState};
use crate::math::elementary::sin_cos;
use crate::model::description::Arc;
use crate::model::kinematics::Mechanism;
use crate::model::machine::Machine;
use nalgebra::Vector2;

type V2 = Vector2<f64>;

#[expect(
    clippy::multiple_inherent_impl,
    reason = "one file per term of the equations"
)]
impl Machine {
    /// Returns the range of the beam angle of the inextensible mechanism \[rad\]: lowest, highest.
    pub fn swing(&self) -> [f64; 2] {
        let mechanism = self.mechanism(self.description.back_arc.radius, self.back_length());
        let mut at = self.bottom;
        let mut highest = at.beam;
        for k in 1..=90 {
            let pin = self.bottom.pin + std::f64::consts::TAU * f64::from(k) / 90.0;
            if let Ok(next) = mechanism.position(pin, at.beam, at.tangent) {
                at = next;
                highest = highest.max(at.beam);
            }
        }
        [self.bottom.beam, highest]
    }

    /// Returns the machine's inextensible mechanism, given its effective back-arc radius \[m\] and its length
    /// from crank pin to anchor along rod and rope \[m\].
    pub fn mechanism(&self, radius: f64, length: f64) -> Mechanism {
        Mechanism {
            crank: self.description.crank,
            arc: Arc {
                radius,
                ..self.description.back_arc
            },
            length,
        }
    }

    /// Returns the length from crank pin to back anchor along the rod and the unstretched rope \[m\].
    pub fn back_length(&self) -> f64 {
        self.description.rope.back as f64 * self.description.rope.pitch
            + self.description.rod.length
    }

    /// Returns the state of crank and load at time `t` under a drive.
    pub fn drive_state(&self, drive: &Drive, t: f64) -> DriveState {
        let [turn, rate, acceleration] = self.extensions.turn(drive.turn(t));
        let crank = &self.description.crank;
        let angle = self.bottom.pin + crank.sense * turn;
        let (w, dw) = (crank.sense * rate, crank.sense * acceleration);
        let (s, c) = sin_cos(angle);
        let arm = V2::new(c, s) * crank.radius;
        let across = V2::new(-arm.y, arm.x);
        DriveState {
            time: t,
            turn,
            pin: [
                V2::new(crank.center[0], crank.center[1]) + arm,
                across * w,
                across * dw - arm * (w * w),
            ],
            pin_angle: angle,
            pin_rate: w,
            load: self.card.value(turn, 0),
        }
    }
}
