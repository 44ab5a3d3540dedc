//! A kind of effect that can be hidden, and an effect that was: what every law here is made into.
use crate::draw::Draw;
use crate::turn::Turn;
use simulation::effect::Effect;
use std::collections::BTreeMap;
use std::sync::Arc;

/// An effect with its size. What acts on the machine itself is the [`Effect`] part, load included;
/// the rest is what becomes of load card and readings on their way to the record.
pub trait Law: Effect {
    /// Makes the delivered card of the true one \[N\]; the crank turns with `speed` [rad/s].
    fn deliver(&self, _card: &mut Vec<f64>, _speed: f64) {}

    /// Changes what the sensors of one turn give.
    fn read(&self, _turn: &mut Turn) {}

    /// Moves the zeros of the gauges \[MPa\], a number of turns after the record's begin.
    fn drift(&self, _turns: f64) -> [f64; 4] {
        [0.0; 4]
    }
}

/// A kind of effect that can be hidden.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Identifier; that of the program's library where it names the effect.
    pub id: &'static str,
    /// Name of the number that is drawn.
    pub parameter: &'static str,
    /// Unit of the number.
    pub unit: &'static str,
    /// Typical size, in that unit.
    pub scale: f64,
    /// Whether it may be negative.
    pub signed: bool,
    /// Most times its scale.
    pub most: f64,
    /// Makes it; shape numbers are drawn and noted.
    build: fn(f64, &mut Draw, &mut Shape) -> Arc<dyn Law>,
}

/// Further numbers of a law, by name with the unit in it.
pub type Shape = BTreeMap<String, f64>;

/// An effect that was hidden.
#[derive(Debug)]
pub struct Hidden {
    /// What it is.
    pub kind: Kind,
    /// Its size in the kind's unit.
    pub size: f64,
    /// Further numbers.
    pub shape: Shape,
    /// The law itself.
    pub law: Arc<dyn Law>,
}

impl Kind {
    /// Hides it with a size in units of its scale.
    pub fn hide(self, times: f64, draw: &mut Draw) -> Hidden {
        let size = times.clamp(-self.most, self.most) * self.scale;
        let mut shape = Shape::new();
        let law = (self.build)(size, draw, &mut shape);
        Hidden {
            kind: self,
            size,
            shape,
            law,
        }
    }
}

/// A shape number, noted.
pub(super) fn note(shape: &mut Shape, name: &str, value: f64) -> f64 {
    shape.insert(name.to_owned(), value);
    value
}

pub(super) const fn kind(
    id: &'static str,
    (parameter, unit): (&'static str, &'static str),
    scale: f64,
    build: fn(f64, &mut Draw, &mut Shape) -> Arc<dyn Law>,
) -> Kind {
    Kind {
        id,
        parameter,
        unit,
        scale,
        signed: false,
        most: 10.0,
        build,
    }
}

pub(super) const fn signed(kind: Kind) -> Kind {
    Kind {
        signed: true,
        ..kind
    }
}

pub(super) const fn at_most(most: f64, kind: Kind) -> Kind {
    Kind { most, ..kind }
}
