//! Descriptor of an effect: identifier, location, parameters with units, bounds and typical sizes, and the
//! constructor of the effect from its parameter values.
//!
//! Parameter values and bounds are in the declared unit; [`Unit::to_si`] converts them to the unit of the
//! equations.
use super::unit::Unit;
use super::value::{Edit, ParameterValues, Read};
use crate::model::description::Description;
use crate::model::extension::Effect;
use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

/// Description of one effect of the catalogue: where it acts, which parameters it has and how to construct
/// it.
#[derive(Clone, Debug)]
pub struct Descriptor {
    /// Permanent identifier of the effect.
    pub id: Cow<'static, str>,
    /// Title of the effect in plain words.
    pub title: Cow<'static, str>,
    /// Joint or part of the machine at which the effect acts.
    pub joint: &'static str,
    /// Part of the model that the effect changes.
    pub place: Place,
    /// Whether the effect is a generic force: one without a physical cause, used only to locate where the
    /// model is wrong.
    pub generic: bool,
    /// Free parameters of the effect.
    pub parameters: Vec<Parameter>,
    build: Build,
}

#[derive(Clone)]
struct Build(Arc<Builder>);

/// Function that constructs an effect from its parameter values.
type Builder = dyn Fn(&ParameterValues) -> Arc<dyn Effect> + Send + Sync;

impl fmt::Debug for Build {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Build")
    }
}

/// Part of the model that an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The machine itself: geometry, inertia or forces.
    Dynamics,
    /// The crank: its motion, or the zero of its angle.
    Drive,
    /// The load at the suspension point.
    Load,
    /// Measuring chain from strain to gauge reading.
    Gauge,
}

/// Free parameter of an effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name of the parameter within its effect.
    pub name: &'static str,
    /// Unit of the parameter's values and bounds.
    pub unit: Unit,
    /// Role of the parameter: size (amplitude) or shape of the effect.
    pub role: Role,
    /// Value of a size parameter at which the effect vanishes; for a shape parameter, the typical value.
    pub absent: f64,
    /// Typical value: for a size, the value at which the effect's signature (change of the gauge curves) is
    /// computed; for a shape, the default.
    pub typical: f64,
    /// Characteristic magnitude of the parameter, used for scaling.
    pub scale: f64,
    /// Lower bound of the parameter.
    pub lower: f64,
    /// Upper bound of the parameter.
    pub upper: f64,
    /// Whether the effect rounds the parameter to a whole number, so that derivatives with respect to it do
    /// not exist.
    pub whole: bool,
}

/// Role of a parameter in its effect: size or shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Amplitude of a contribution of the effect; the contribution vanishes at the parameter's absent value.
    Size,
    /// Parameter that changes the form of a size's contribution, such as a time constant.
    ///
    /// A shape is expensive: a diagnosis computes the signature (change of the gauge curves) of every size at
    /// six values of every shape, so that one shape costs **six signatures per size**. A shape must change
    /// the *form* of a size's contribution, never only its magnitude: a record determines only the product of
    /// a factor and a size. A pure factor belongs into the size or is a constant of the effect (a contract
    /// test of the catalogue refuses it as a shape).
    Shape,
}

impl Parameter {
    /// Returns whether the parameter is a size whose lower bound is its absent value, so that the effect has
    /// one sign only.
    pub fn is_one_sided(&self) -> bool {
        self.role == Role::Size && self.lower >= self.absent
    }
}

impl Descriptor {
    /// Creates a descriptor with an identifier and a title but without location, parameters and constructor.
    /// Callers add [`Self::with_location`], the parameters, and last [`Self::with_constructor`].
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

    /// Sets the joint or part at which the effect acts, and the part of the model that it changes.
    pub(super) fn with_location(self, joint: &'static str, place: Place) -> Self {
        Self {
            joint,
            place,
            ..self
        }
    }

    /// Marks the effect as a generic force without a physical cause.
    pub(super) fn generic(self) -> Self {
        Self {
            generic: true,
            ..self
        }
    }

    /// Adds a size parameter whose absent value is 0. A lower bound of 0 makes it one-sided.
    pub(super) fn size(
        self,
        name: &'static str,
        unit: Unit,
        typical: f64,
        bounds: [f64; 2],
    ) -> Self {
        self.sizes([name], unit, typical, bounds)
    }

    /// Adds several size parameters that differ only in their names.
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

    /// Adds a shape parameter with its typical value; [`Role::Shape`] states the signatures that it costs.
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

    /// Marks the parameter added last as rounded to a whole number.
    pub(super) fn whole(mut self) -> Self {
        if let Some(last) = self.parameters.last_mut() {
            last.whole = true;
        }
        self
    }

    /// Sets the function that constructs the effect from its parameter values.
    pub(super) fn with_constructor<E: Effect + 'static>(
        mut self,
        build: impl Fn(&ParameterValues) -> E + Send + Sync + 'static,
    ) -> Self {
        self.build = Build(Arc::new(move |values| Arc::new(build(values))));
        self
    }

    /// Sets a constructor for an effect that only edits the machine description, by the given function.
    pub(super) fn with_edit(self, edit: fn(&ParameterValues, &mut Description)) -> Self {
        self.with_constructor(move |v| Edit {
            values: v.clone(),
            edit,
        })
    }

    /// Sets a constructor for an effect that only changes gauge readings, sample by sample, by the given
    /// function of values, elapsed share of the recorded revolution and readings.
    pub(super) fn with_reading(self, read: fn(&ParameterValues, f64, &mut [f64; 4])) -> Self {
        self.with_constructor(move |v| Read {
            values: v.clone(),
            read,
        })
    }

    /// Returns the index of a parameter by its name.
    pub fn parameter(&self, name: &str) -> Option<usize> {
        self.parameters.iter().position(|p| p.name == name)
    }

    /// Constructs the effect from one value per parameter, in declared units and in the order of
    /// [`Self::parameters`], even if the values make it vanish.
    pub fn build(&self, values: &[f64]) -> Arc<dyn Effect> {
        let of = self.parameters.iter().zip(values);
        let si = of.map(|(p, value)| (p.name, p.unit.to_si(*value)));
        (self.build.0)(&ParameterValues(si.collect()))
    }

    /// Returns whether the given values leave every size parameter exactly at its absent value, so that the
    /// effect vanishes.
    pub fn is_absent(&self, values: &[f64]) -> bool {
        let mut of = self.parameters.iter().zip(values);
        #[expect(clippy::float_cmp, reason = "absent is exactly absent")]
        of.all(|(p, value)| p.role == Role::Shape || *value == p.absent)
    }
}

/// Placeholder effect of a descriptor without a constructor.
#[derive(Debug)]
struct Nothing;

impl Effect for Nothing {}
