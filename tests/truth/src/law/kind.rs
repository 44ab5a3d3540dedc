//! Kinds of effects that can be hidden in a record, and hidden effects with their drawn parameters.
use crate::draw::RandomStream;
use crate::turn::Turn;
use simulation::effect::Effect;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Hidden effect of a given size. The supertrait [`Effect`] acts on the machine itself, including its load;
/// the methods here change the load card and the readings on their way to the record.
pub trait HiddenEffect: Effect {
    /// Converts the true load card to the delivered one \[N\]; the crank turns with `speed` [rad/s].
    fn distort_card(&self, _card: &mut Vec<f64>, _speed: f64) {}

    /// Changes the sensor readings of one simulated crank turn.
    fn distort_readings(&self, _turn: &mut Turn) {}

    /// Returns the zero drift of the gauges \[MPa\] at a number of turns after the start of the record.
    fn drift(&self, _turns: f64) -> [f64; 4] {
        [0.0; 4]
    }
}

/// Kind of effect that can be hidden in a record.
#[derive(Clone, Copy, Debug)]
pub struct EffectKind {
    /// Identifier of the kind; for an effect that the library of candidate effects contains, the library's
    /// identifier.
    pub id: &'static str,
    /// Name of the effect's size parameter, whose value is drawn.
    pub parameter: &'static str,
    /// Unit of the size parameter.
    pub unit: &'static str,
    /// Typical size of the effect, in `unit`.
    pub scale: f64,
    /// Whether the size of the effect may be negative.
    pub signed: bool,
    /// Largest size of the effect in multiples of `scale`.
    pub largest_multiple: f64,
    /// Constructor of the effect, which draws its shape parameters and stores them in the given map.
    build: fn(f64, &mut RandomStream, &mut Shape) -> Arc<dyn HiddenEffect>,
}

/// Drawn shape parameters of a hidden effect, by names that end in the units.
pub type Shape = BTreeMap<String, f64>;

/// Effect hidden in a record.
#[derive(Debug)]
pub struct PlantedEffect {
    /// Kind of the hidden effect.
    pub kind: EffectKind,
    /// Size of the hidden effect, in the unit of its kind.
    pub size: f64,
    /// Drawn shape parameters of the hidden effect.
    pub shape: Shape,
    /// Law by which the effect acts on the machine or the readings.
    pub law: Arc<dyn HiddenEffect>,
}

impl EffectKind {
    /// Creates a hidden effect of this kind whose size is `times` the kind's typical size.
    pub fn instantiate(self, times: f64, draw: &mut RandomStream) -> PlantedEffect {
        let size = times.clamp(-self.largest_multiple, self.largest_multiple) * self.scale;
        let mut shape = Shape::new();
        let law = (self.build)(size, draw, &mut shape);
        PlantedEffect {
            kind: self,
            size,
            shape,
            law,
        }
    }
}

/// Stores a drawn shape parameter of a hidden effect for the sealed answer and returns its value.
pub(super) fn record_shape(shape: &mut Shape, name: &str, value: f64) -> f64 {
    shape.insert(name.to_owned(), value);
    value
}

pub(super) const fn kind(
    id: &'static str,
    (parameter, unit): (&'static str, &'static str),
    scale: f64,
    build: fn(f64, &mut RandomStream, &mut Shape) -> Arc<dyn HiddenEffect>,
) -> EffectKind {
    EffectKind {
        id,
        parameter,
        unit,
        scale,
        signed: false,
        largest_multiple: 10.0,
        build,
    }
}

pub(super) const fn signed(kind: EffectKind) -> EffectKind {
    EffectKind {
        signed: true,
        ..kind
    }
}

pub(super) const fn at_most(most: f64, kind: EffectKind) -> EffectKind {
    EffectKind {
        largest_multiple: most,
        ..kind
    }
}
