//! Announcement by which a worker introduces itself before it receives jobs.
use serde::{Deserialize, Serialize};

/// Introduction of a worker, on which the coordinator bases admission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Announcement {
    /// Version of the protocol that the worker uses, [`crate::wire::VERSION`].
    pub protocol: u8,
    /// Package version and build profile of the worker's binary.
    pub build: String,
    /// Host name of the worker's machine.
    pub host: String,
    /// Process id of the worker on its machine.
    pub pid: u32,
    /// Number of the worker's slots, i.e. jobs computed at a time.
    pub slots: u32,
    /// Number of hardware threads of the worker's machine.
    pub cores: u32,
    /// Kinds of job that the worker can execute, by [`crate::job::Job::kind`].
    pub job_kinds: Vec<String>,
    /// Models that the worker can simulate.
    pub models: Vec<ModelDescriptor>,
}

/// Kind of model as implemented by one build of a worker.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelDescriptor {
    /// Name of the model kind, as stated in cases ([`crate::case::ModelSettings::kind`]).
    pub kind: String,
    /// Digest of the numerics: equal digests guarantee bitwise equal results.
    pub digest: String,
    /// Effects that the model can add to the machine described by a case.
    pub effects: Vec<EffectDescriptor>,
}

/// Effect that a model can add, described in enough detail to be proposed, estimated and searched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectDescriptor {
    /// Fixed identifier of the effect, as used in results, e.g. `pivot_friction`.
    pub id: String,
    /// Description of the effect in words.
    pub title: String,
    /// Joint or part of the model at which the effect acts, e.g. `saddle` or `guide`.
    pub joint: String,
    /// Part of the model that the effect changes: dynamics, drive, load or sensor.
    pub place: Place,
    /// Whether the effect is a generic force without a physical cause, used only to find where a model is
    /// wrong.
    pub generic: bool,
    /// Parameters of the effect.
    pub parameters: Vec<ParameterDescriptor>,
}

/// Part of a model that an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Geometry, inertia or forces of the machine.
    Dynamics,
    /// Driving motion, or the zero of the driving angle.
    Drive,
    /// Load applied to the machine.
    Load,
    /// Measurement chain from the measured quantity to the reading.
    Sensor,
}

/// Parameter of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterDescriptor {
    /// Name of the parameter within its effect.
    pub name: String,
    /// Unit of all values of the parameter, as text.
    pub unit: String,
    /// Role of the parameter: whether it switches the effect on or only shapes it.
    pub role: Role,
    /// Signs that the parameter may have.
    pub sign: Sign,
    /// Lower bound of the parameter.
    pub lower: f64,
    /// Upper bound of the parameter.
    pub upper: f64,
    /// Value at which the effect vanishes; for a shape parameter its typical value.
    pub absent: f64,
    /// Parameter value at which the effect's influence on the channels is computed; the default of a shape
    /// parameter.
    pub typical: f64,
    /// Typical magnitude of the parameter on machines of this kind.
    pub scale: f64,
}

/// Role of a parameter in its effect: size or shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// Size of the effect, for example a friction coefficient: at one value of it the effect vanishes.
    Size,
    /// Shape of the effect, for example a velocity scale: acts only once the effect's size parameters switch
    /// it on.
    Shape,
}

/// Signs that a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sign {
    /// Values above and below the value at which the effect vanishes.
    Either,
    /// Values not below the one at which the effect vanishes, as for dissipation, distances and times.
    Positive,
}
