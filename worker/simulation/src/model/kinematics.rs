//! Kinematics of the unit with inextensible ropes that lie exactly on the arcs.
//!
//! With the support function `h(psi) = R + C.n(psi)` of the back arc, the rope's tangent point
//! `psi` and the beam angle `theta` obey, for the crank pin `P` and `Psi = psi + theta`,
//! `P.n(Psi) = h(psi)` (tangency) and
//! `P.t(Psi) - h'(psi) + R (psi - psi_anchor) = L` (length of rope and rod).
//! `h` is the effective back arm: `d theta / d phi = (dP/dphi . t) / h`.
use crate::math::elementary::sin_cos;
use crate::model::description::{Arc, Crank, Description};

/// Solved position of the mechanism at one crank angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position {
    /// Turn angle of the crank pin \[rad\].
    pub pin: f64,
    /// Beam angle \[rad\].
    pub beam: f64,
    /// Arc angle at which the rope touches the back arc tangentially, in the beam frame \[rad\].
    pub tangent: f64,
    /// Effective lever arm of the back rope about the pivot, `h` \[m\].
    pub arm: f64,
    /// Derivative of the beam angle with respect to the pin angle \[1\].
    pub ratio: f64,
}

/// Planar mechanism of crank, rod, rope and back arc.
#[derive(Clone, Copy, Debug)]
pub struct Mechanism {
    /// Parameters of the mechanism's crank.
    pub crank: Crank,
    /// Arc of the back head; its radius may be reduced by a contact penetration.
    pub arc: Arc,
    /// Length from the crank pin to the rope's anchor along rod and rope \[m\].
    pub length: f64,
}

/// Error: the mechanism cannot be closed at some pin angle.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("rope and rod cannot reach from the crank pin to the head at pin angle {pin_deg:.1} deg")]
pub struct DoesNotClose {
    /// Pin angle at which the mechanism cannot be closed \[deg\].
    pub pin_deg: f64,
}

impl Mechanism {
    /// Builds the mechanism of a description, with the unstretched lengths of rope and rod.
    pub fn of(d: &Description) -> Self {
        Self {
            crank: d.crank,
            arc: d.back_arc,
            length: d.rope.back as f64 * d.rope.pitch + d.rod.length,
        }
    }

    /// Returns the position of the crank pin at an angle \[m\].
    pub fn pin(&self, angle: f64) -> [f64; 2] {
        let (s, c) = sin_cos(angle);
        [
            self.crank.center[0] + self.crank.radius * c,
            self.crank.center[1] + self.crank.radius * s,
        ]
    }

    /// Solves the position at a pin angle by Newton's method, starting from `beam` and `tangent`.
    ///
    /// # Errors
    /// [`DoesNotClose`] if Newton's method does not converge.
    pub fn position(&self, pin: f64, beam: f64, tangent: f64) -> Result<Position, DoesNotClose> {
        let p = self.pin(pin);
        let (mut theta, mut world) = (beam, beam + tangent);
        for _ in 0..60 {
            let psi = world - theta;
            let (sn, cn) = sin_cos(world);
            let (s, c) = sin_cos(psi);
            let [cx, cy] = self.arc.center;
            let h = self.arc.radius + cx * c + cy * s;
            let slope = cy * c - cx * s;
            let along = p[1] * cn - p[0] * sn;
            let across = p[0] * cn + p[1] * sn;
            let r0 = across - h;
            let r1 = along - slope + self.arc.radius * (psi - self.arc.anchor) - self.length;
            // d r0 = slope dtheta + (along - slope) dPsi; d r1 = -h dtheta + (h - across) dPsi
            let (a, b, d, e) = (slope, along - slope, -h, h - across);
            let det = a * e - b * d;
            let (mut dt, mut dw) = ((b * r1 - e * r0) / det, (d * r0 - a * r1) / det);
            let size = dt.abs().max(dw.abs());
            if !size.is_finite() {
                break;
            }
            if size > 0.3 {
                dt *= 0.3 / size;
                dw *= 0.3 / size;
            }
            theta += dt;
            world += dw;
            if size < 1e-12 {
                let (sn, cn) = sin_cos(pin);
                let (st, ct) = sin_cos(world);
                let travel = self.crank.radius * (cn * ct + sn * st);
                return Ok(Position {
                    pin,
                    beam: theta,
                    tangent: world - theta,
                    arm: h,
                    ratio: travel / h,
                });
            }
        }
        Err(DoesNotClose {
            pin_deg: pin.to_degrees(),
        })
    }

    /// Solves the position with the lowest beam angle: bottom dead centre.
    ///
    /// # Errors
    /// [`DoesNotClose`] if the crank cannot make a full turn.
    pub fn bottom_dead_centre(&self) -> Result<Position, DoesNotClose> {
        let turn = std::f64::consts::TAU;
        let mut at = self.position(0.0, 0.0, std::f64::consts::PI)?;
        let mut lowest = at;
        for k in 1..=360 {
            at = self.position(turn * f64::from(k) / 360.0, at.beam, at.tangent)?;
            if at.beam < lowest.beam {
                lowest = at;
            }
        }
        let mut low = self.position(lowest.pin - turn / 360.0, lowest.beam, lowest.tangent)?;
        let mut high = self.position(lowest.pin + turn / 360.0, lowest.beam, lowest.tangent)?;
        for _ in 0..200 {
            let middle = 0.5 * (low.pin + high.pin);
            let next = self.position(middle, low.beam, low.tangent)?;
            if next.ratio < 0.0 {
                low = next;
            } else {
                high = next;
            }
        }
        Ok(high)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ratio_is_the_derivative_of_the_beam_angle() {
        let mechanism = Mechanism {
            crank: Crank {
                center: [-2.6, -5.1],
                radius: 1.0973,
                sense: -1.0,
                speed: 0.5,
                counterweight_moment: 0.0,
                counterweight_phase: 0.0,
            },
            arc: Arc {
                center: [-0.15, -0.58],
                radius: 1.9,
                anchor: 125_f64.to_radians(),
                sense: -1.0,
            },
            length: 6.476,
        };
        let bottom = mechanism.bottom_dead_centre().unwrap();
        assert!(bottom.ratio.abs() < 1e-12);
        for pin in [0.3, 2.0, 5.1] {
            let at = mechanism.position(pin, 0.0, 3.0).unwrap();
            let h = 1e-5;
            let plus = mechanism.position(pin + h, at.beam, at.tangent).unwrap();
            let minus = mechanism.position(pin - h, at.beam, at.tangent).unwrap();
            let difference = (plus.beam - minus.beam) / (2.0 * h);
            assert!((difference - at.ratio).abs() < 1e-9);
            assert!(at.beam >= bottom.beam);
        }
    }
}
