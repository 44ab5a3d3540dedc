//! What an effect says of itself: its name, where it acts, and its free numbers with their units,
//! bounds and sizes; and how it is made of their values.
//!
//! All numbers are in the declared unit; [`Unit::to_si`] gives what the equations take.
use super::unit::Unit;
use super::value::{Edit, Read, Values};
use crate::model::description::Description;
use crate::model::hook::{Effect, Sampled};
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

/// One effect of the catalogue.
#[derive(Clone, Debug)]
pub struct Descriptor {
    /// Fixed identifier.
    pub id: Cow<'static, str>,
    /// In words.
    pub title: Cow<'static, str>,
    /// Joint or part of the machine that it acts at.
    pub joint: &'static str,
    /// What of the model it changes.
    pub place: Place,
    /// Whether it is a form of force without a cause, for localisation alone.
    pub generic: bool,
    /// Its free numbers.
    pub parameters: Vec<Parameter>,
    build: Build,
}

/// How an effect is made of its values.
#[derive(Clone)]
struct Build(Arc<Builder>);

/// From values to the effect that has them.
type Builder = dyn Fn(&Values) -> Arc<dyn Effect> + Send + Sync;

impl fmt::Debug for Build {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Build")
    }
}

/// What of the model an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Geometry, inertia or forces of the machine.
    Dynamics,
    /// The motion of the crank, or where its angle is zero.
    Drive,
    /// The load at the suspension point.
    Load,
    /// The chain from strain to reading.
    Gauge,
}

/// One free number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name within the effect.
    pub name: &'static str,
    /// Unit of all its values.
    pub unit: Unit,
    /// What it does for its effect.
    pub role: Role,
    /// Value at which the effect is not there; of a shape, its typical value.
    pub absent: f64,
    /// Value with which a signature is taken, and the default of a shape.
    pub typical: f64,
    /// Its physical size.
    pub scale: f64,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Whether its effect rounds it to a whole number: then nothing has a derivative by it.
    pub whole: bool,
}

/// What a parameter does for its effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// At its absent value it contributes nothing.
    Size,
    /// It forms what the sizes switch on.
    ///
    /// A shape is dear: a diagnosis takes the signature of every size at six values of every shape,
    /// so that one shape costs **six signatures per size**. It must change the *form* of what a size
    /// does, never only how large that is: of a factor and a size no record tells more than their
    /// product. What is a factor belongs into the size, or is a constant of the effect (a contract test
    /// of the catalogue refuses it).
    Shape,
}

impl Parameter {
    /// Whether it can only be at or above its absent value.
    pub fn is_one_sided(&self) -> bool {
        self.role == Role::Size && self.lower >= self.absent
    }
}

impl Descriptor {
    /// An effect of this identifier and title that is nowhere yet and has no parameters. Those who
    /// make one say [`Self::at`], its parameters, and last [`Self::builds`].
    pub(super) fn new(
        id: impl Into<Cow<'static, str>>,
        title: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self {
            id: id.into(),
            title: title.into(),
            joint: "",
            place: Place::Dynamics,
            generic: false,
            parameters: Vec::new(),
            build: Build(Arc::new(|_| Arc::new(Nothing))),
        }
    }

    /// Joint or part that it acts at, and what of the model it changes.
    pub(super) fn at(self, joint: &'static str, place: Place) -> Self {
        Self {
            joint,
            place,
            ..self
        }
    }

    /// A form of force without a cause.
    pub(super) fn generic(self) -> Self {
        Self {
            generic: true,
            ..self
        }
    }

    /// Adds a size: absent at 0. Bounds that exclude what is negative make it one-sided.
    pub(super) fn size(
        self,
        name: &'static str,
        unit: Unit,
        typical: f64,
        bounds: [f64; 2],
    ) -> Self {
        self.sizes([name], unit, typical, bounds)
    }

    /// Adds sizes that are alike but for their names.
    pub(super) fn sizes<const N: usize>(
        mut self,
        names: [&'static str; N],
        unit: Unit,
        typical: f64,
        [lower, upper]: [f64; 2],
    ) -> Self {
        self.parameters.extend(names.map(|name| Parameter {
            name,
            unit,
            role: Role::Size,
            absent: 0.0,
            typical,
            scale: typical.abs(),
            lower,
            upper,
            whole: false,
        }));
        self
    }

    /// Adds a shape with its typical value; see [`Role::Shape`] for what it costs.
    pub(super) fn shape(
        mut self,
        name: &'static str,
        unit: Unit,
        typical: f64,
        [lower, upper]: [f64; 2],
    ) -> Self {
        self.parameters.push(Parameter {
            name,
            unit,
            role: Role::Shape,
            absent: typical,
            typical,
            scale: 0.5 * (upper - lower),
            lower,
            upper,
            whole: false,
        });
        self
    }

    /// The parameter that was added last is rounded to a whole number.
    pub(super) fn whole(mut self) -> Self {
        if let Some(last) = self.parameters.last_mut() {
            last.whole = true;
        }
        self
    }

    /// How it is made of its values.
    pub(super) fn builds<E: Effect + 'static>(
        mut self,
        build: impl Fn(&Values) -> E + Send + Sync + 'static,
    ) -> Self {
        self.build = Build(Arc::new(move |values| Arc::new(build(values))));
        self
    }

    /// For an effect that edits the description and does nothing else: how.
    pub(super) fn edits(self, edit: fn(&Values, &mut Description)) -> Self {
        self.builds(move |v| Edit {
            values: v.clone(),
            edit,
        })
    }

    /// For an effect that changes single readings of the gauges and does nothing else: how.
    pub(super) fn reads(self, read: fn(&Values, &Sampled, &mut [f64; 4])) -> Self {
        self.builds(move |v| Read {
            values: v.clone(),
            read,
        })
    }

    /// Position of a parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// The effect with a value for each parameter, in declared units and in the order of
    /// [`Self::parameters`], be it absent or not.
    pub fn build(&self, values: &[f64]) -> Arc<dyn Effect> {
        let of = self.parameters.iter().zip(values);
        let si = of.map(|(p, value)| (p.name, p.unit.to_si(*value)));
        (self.build.0)(&Values(si.collect()))
    }

    /// Whether values leave it absent: every size at its absent value.
    pub fn is_absent(&self, values: &[f64]) -> bool {
        let mut of = self.parameters.iter().zip(values);
        #[expect(clippy::float_cmp, reason = "absent is exactly absent")]
        of.all(|(p, value)| p.role == Role::Shape || *value == p.absent)
    }
}

/// What a descriptor builds before it is told what to build.
#[derive(Debug)]
struct Nothing;

impl Effect for Nothing {}
