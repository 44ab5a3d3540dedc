//! Clearance in the pins that hold the back head: the load path switches where the head's force on a pin
//! reverses.
//!
//! The rope pushes the head along the beam with `f = -T sin(psi)`, alternately backwards and forwards; a
//! pin's share of force and couple reverses along a direction `d` and under a bias `f_1` from the head's
//! weight. There the head shifts by the clearance and bears on the other side of the hole, which changes the
//! stress in the surrounding steel by a step: `s_i + c_i tanh((R.d - f_1) / f_0)`, with `R` the rope's force
//! on the head and `f_0` the force over which the bearing side changes. The height `c_i` of the step at each
//! gauge depends on the gap and on the steel between pin and gauge; gauges determine only the product.
//!
//! The default direction and bias are those at which the records of the CYJS10-5-37HB show steps: turn 128.5
//! and 276 deg at both 5 and 4 rpm, rope tensions of 135 and 88 kN.
//!
//! Source: joints with clearance: Flores, Ambrósio, Claro and Lankarani, *Kinematics and Dynamics of
//! Multibody Systems with Imperfect Joints* (2008); the relation to gauge readings is our own.
use crate::effect::descriptor::{Descriptor, Place};
use crate::effect::unit::Unit;
use crate::math::elementary::{sin_cos, tanh};
use crate::model::extension::{Effect, Extensions, Reading, SampleState, Site};

pub(super) fn descriptor() -> Descriptor {
    Descriptor::new(
        "pin_clearance",
        "Clearance of the pins that hold the back head",
    )
    .with_location("pin_b", Place::Gauge)
    .sizes(
        ["step_1", "step_2", "step_3", "step_4"],
        Unit::Megapascal,
        0.5,
        [-20.0, 20.0],
    )
    .shape("direction", Unit::Degree, -13.5, [-45.0, 45.0])
    .shape("bias", Unit::Newton, -7500.0, [-4e4, 4e4])
    .shape("force", Unit::Newton, 2000.0, [200.0, 5e4])
    .with_constructor(|v| {
        let (sine, cosine) = sin_cos(v.get("direction"));
        Clearance {
            step: v.each(["step_1", "step_2", "step_3", "step_4"]),
            direction: [cosine, sine],
            bias: v.get("bias"),
            force: v.get("force"),
        }
    })
}

#[derive(Clone, Copy, Debug)]
struct Clearance {
    step: [f64; 4],
    /// Unit vector in the beam frame along which the pin force reverses.
    direction: [f64; 2],
    bias: f64,
    force: f64,
}

impl Effect for Clearance {
    fn install(&self, _: &Site<'_>, extensions: &mut Extensions) {
        extensions.add_reading(*self);
    }
}

impl Reading for Clearance {
    fn sample(&self, at: &SampleState, stress: &mut [f64; 4]) {
        let (s, c) = sin_cos(at.beam);
        let [x, y] = at.head_force;
        let push = [c * x + s * y, c * y - s * x];
        let along = push[0] * self.direction[0] + push[1] * self.direction[1];
        let side = tanh((along - self.bias) / self.force);
        for (stress, step) in stress.iter_mut().zip(self.step) {
            *stress += step * side;
        }
    }
}
