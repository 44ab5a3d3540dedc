//! What a worker says of itself before it is given work.
use serde::{Deserialize, Serialize};

/// A worker's introduction; what the coordinator decides admission by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Announcement {
    /// Version of the protocol it speaks, [`crate::wire::VERSION`].
    pub protocol: u8,
    /// Package version and profile of its binary.
    pub build: String,
    /// Names the numerics: equal digests promise equal bits.
    pub model_digest: String,
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
    /// Effects its model can add to the machine.
    pub effects: Vec<EffectDescriptor>,
}

/// One effect that a model may add, described well enough to be proposed and searched.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct EffectDescriptor {
    /// Fixed identifier, as in results.
    pub id: String,
    /// In words.
    pub title: String,
    /// Its free numbers.
    pub parameters: Vec<ParameterDescriptor>,
}

/// One free number of an effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ParameterDescriptor {
    /// Name within the effect.
    pub name: String,
    /// Unit of all its values, as written.
    pub unit: String,
    /// Least value.
    pub lower: f64,
    /// Greatest value.
    pub upper: f64,
    /// Value at which the effect is not there.
    pub absent: f64,
}
