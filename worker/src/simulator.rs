//! What a kind of model does for a worker: all that queues, slots, replies and scores know of it.
//!
//! A new kind is a folder that implements both traits, and an entry in the list that the worker's
//! program is given ([`crate::program::run`]).
use protocol::{
    announce::{EffectDescriptor, ModelDescriptor},
    case::Case,
    job::{Column, Curves, Failure, Observation, SimulateSpec},
};
use std::{fmt, time::Instant};

/// The kinds of model that a worker program simulates.
pub type Simulators = &'static [&'static dyn Simulator];

/// A kind of model.
pub trait Simulator: fmt::Debug + Sync {
    /// Its name, as cases state it.
    fn kind(&self) -> &'static str;

    /// Names the numerics of this build: equal digests promise equal bits. It may take some tenths of
    /// a second the first time in a process.
    fn digest(&self) -> String;

    /// Effects that it can add to what a case describes.
    fn effects(&self) -> Vec<EffectDescriptor>;

    /// What it announces: itself, or each of what it can be here.
    fn described(&self) -> Vec<ModelDescriptor> {
        vec![ModelDescriptor {
            kind: self.kind().to_owned(),
            digest: self.digest(),
            effects: self.effects(),
        }]
    }

    /// Whether it simulates cases of a kind, as they name it on the wire.
    fn simulates(&self, kind: &str) -> bool {
        kind == self.kind()
    }

    /// Derivatives that every worker of a run computes of the case's reference individual when it joins, beside the
    /// curves: one of each way in which this kind of model comes by them. None where it gives none.
    fn reference_columns(&self, _case: &Case) -> Vec<Column> {
        Vec::new()
    }

    /// Builds the model of a case.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] naming the field of the case that it cannot be built from.
    fn prepare(&self, case: &Case) -> Result<Box<dyn Model>, Failure>;

    /// Does a job that only this kind knows, without any case; what is asked and what is answered are
    /// its own business.
    ///
    /// # Errors
    /// [`Failure::Refused`] for a name that it does not know, [`Failure::Misconfigured`] for what
    /// cannot be done.
    fn own(&self, name: &str, body: &[u8]) -> Result<Vec<u8>, Failure>;
}

/// A model of one case, ready for any number of jobs on it; each leaves nothing behind for the next.
pub trait Model: fmt::Debug + Send + Sync {
    /// Simulates, and says what the channels of the condition show, exactly as computed, with their
    /// derivatives by the columns of the job: [`protocol::job::Derivative::none`] of a model that gives
    /// none, and nothing of a run that fails. Columns change no bit of the curves. Where
    /// `scored_only` says that the others are not looked at, only curves of channels with a record need
    /// be there.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] where the job does not fit the case.
    fn observe(&self, spec: &SimulateSpec, scored_only: bool) -> Result<Observation, Failure>;

    /// Simulates, and says everything that can be drawn; `pictures` is how many of what
    /// moves are wanted over the whole run, 0 for none. Derivatives come with it as with [`Self::observe`]. A
    /// model that has nothing beside its channels need not say anything here.
    ///
    /// # Errors
    /// As [`Self::observe`].
    fn draw(&self, spec: &SimulateSpec, _pictures: u32) -> Result<Curves, Failure> {
        let began = Instant::now();
        let seen = self.observe(spec, false)?;
        Ok(Curves {
            verdict: seen.verdict,
            counters: seen.counters,
            wall_s: began.elapsed().as_secs_f64(),
            channels: seen.curves,
            columns: seen.columns,
            columns_wall_s: 0.0,
            details: Vec::new(),
        })
    }
}

/// What a worker says of the models that it simulates.
pub fn described(simulators: Simulators) -> Vec<ModelDescriptor> {
    let all = simulators.iter();
    all.flat_map(|simulator| simulator.described()).collect()
}

/// The simulator of a case.
///
/// # Errors
/// [`Failure::Misconfigured`] if there is none for its kind.
pub fn simulator_of(
    simulators: Simulators,
    case: &Case,
) -> Result<&'static dyn Simulator, Failure> {
    let kind = &case.model.kind;
    let mut all = simulators.iter();
    let found = all.find(|simulator| simulator.simulates(kind)).copied();
    found.ok_or_else(|| {
        let kinds: Vec<&str> = simulators.iter().map(|it| it.kind()).collect();
        let problem = format!("is \"{kind}\"; this worker simulates {}", kinds.join(", "));
        Failure::misconfigured("model.kind", problem)
    })
}
