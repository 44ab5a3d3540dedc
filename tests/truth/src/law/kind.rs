//! Kinds of effects that can be hidden in a record, and hidden effects with their drawn parameters.
use crate::draw::Draw;
use crate::turn::Turn;
use simulation::effect::Effect;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Hidden effect with its size. The supertrait [`Effect`] acts on the machine itself, including its load; the
/// methods here change the load card and the readings on their way to the record.
pub trait Law: Effect {
    /// Converts the true load card to the delivered one \[N\]; the crank turns with `speed` [rad/s].
    fn deliver(&self, _card: &mut Vec<f64>, _speed: f64) {}

    /// Changes the sensor readings of one turn.
    fn read(&self, _turn: &mut Turn) {}

    /// Returns the zero drift of the gauges \[MPa\] at a number of turns after the start of the record.
    fn drift(&self, _turns: f64) -> [f64; 4] {
        [0.0; 4]
    }
}

/// Kind of effect that can be hidden.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    /// Identifier; the one of the library of candidate effects if it contains the effect.
    pub id: &'static str,
    /// Name of the drawn size parameter.
    pub parameter: &'static str,
    /// Unit of the size parameter.
    pub unit: &'static str,
    /// Typical size, in `unit`.
    pub scale: f64,
    /// Whether the size may be negative.
    pub signed: bool,
    /// Largest size in multiples of `scale`.
    pub most: f64,
    /// Constructor of the effect, which draws its shape parameters and records them.
    build: fn(f64, &mut Draw, &mut Shape) -> Arc<dyn Law>,
}

/// Shape parameters of an effect, by name including the unit.
pub type Shape = BTreeMap<String, f64>;

/// Effect hidden in a record.
#[derive(Debug)]
pub struct Hidden {
    /// Kind of the effect.
    pub kind: Kind,
    /// Size in the kind's unit.
    pub size: f64,
    /// Drawn shape parameters.
    pub shape: Shape,
    /// Effect that acts on the machine or the readings.
    pub law: Arc<dyn Law>,
}

impl Kind {
    /// Creates a hidden effect whose size is `times` the typical size.
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

/// Records a shape parameter and returns it.
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
