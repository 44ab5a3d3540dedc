//! What a worker says of itself before it is given work.
use serde::{Deserialize, Serialize};

/// A worker's introduction; what the coordinator decides admission by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Announcement {
    /// Version of the protocol it speaks, [`crate::wire::VERSION`].
    pub protocol: u8,
    /// Package version and profile of its binary.
    pub build: String,
    /// Name of its machine.
    pub host: String,
    /// Its process on that machine.
    pub pid: u32,
    /// Jobs it computes at a time.
    pub slots: u32,
    /// Hardware threads of its machine.
    pub cores: u32,
    /// Kinds of job it can do, by [`crate::job::Job::kind`].
    pub job_kinds: Vec<String>,
    /// What it can simulate.
    pub models: Vec<ModelDescriptor>,
}

/// A kind of model as one build of a worker simulates it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelDescriptor {
    /// Name of the kind, as cases state it ([`crate::case::ModelSettings::kind`]).
    pub kind: String,
    /// Names the numerics: equal digests promise equal bits.
    pub digest: String,
    /// Effects that it can add to what a case describes.
    pub effects: Vec<EffectDescriptor>,
}

/// One effect that a model may add, described well enough to be proposed, sized and searched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectDescriptor {
    /// Fixed identifier, as in results.
    pub id: String,
    /// In words.
    pub title: String,
    /// Joint or part of the model that it acts at, as `saddle` or `guide`.
    pub joint: String,
    /// What of the model it changes.
    pub place: Place,
    /// Whether it is a form of force without a cause, for localisation alone.
    pub generic: bool,
    /// Its free numbers.
    pub parameters: Vec<ParameterDescriptor>,
}

/// What of a model an effect changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Place {
    /// Geometry, inertia or forces.
    Dynamics,
    /// The motion that drives it, or where its angle is zero.
    Drive,
    /// The load that is applied.
    Load,
    /// The chain from what is measured to the reading.
    Sensor,
}

/// One free number of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterDescriptor {
    /// Name within the effect.
    pub name: String,
    /// Unit of all its values, as written.
    pub unit: String,
    /// Whether it switches the effect on, or only shapes it.
    pub role: Role,
    /// Signs that it may have.
    pub sign: Sign,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Value at which the effect is not there; of a shape, its typical value.
    pub absent: f64,
    /// Value with which its signature is taken, and the default of a shape.
    pub typical: f64,
    /// Its physical size: how large it commonly is on machines of this kind.
    pub scale: f64,
}

/// What a parameter does for its effect.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// At its absent value it contributes nothing.
    Size,
    /// It forms what the sizes switch on.
    Shape,
}

/// Signs that a parameter may have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sign {
    /// Above and below its absent value.
    Either,
    /// Not below its absent value: what dissipates, what is a distance, a time.
    Positive,
}
