//! Interface of a kind of model: all that queues, slots, replies and scores know of a simulator.
//!
//! A new kind is a folder that implements [`Simulator`] and [`Model`], and an entry in the list that is
//! passed to the worker program ([`crate::program::run`]).
use protocol::{
    announce::{EffectDescriptor, ModelDescriptor},
    case::Case,
    job::{Column, Curves, Failure, Observation, SimulateSpec},
};
use std::{fmt, time::Instant};

/// Kinds of model that a worker program simulates.
pub type Simulators = &'static [&'static dyn Simulator];

/// Kind of model, for example the pumping unit, as a worker simulates it.
pub trait Simulator: fmt::Debug + Sync {
    /// Returns the name of the kind of model, as stated in cases.
    fn kind(&self) -> &'static str;

    /// Returns a digest of the numerics of this build: equal digests promise equal bits. The first call in a
    /// process may take some tenths of a second.
    fn digest(&self) -> String;

    /// Returns the effects that the model can add to a case.
    fn effects(&self) -> Vec<EffectDescriptor>;

    /// Returns the model descriptions that a worker announces: one for the kind itself, or one for each
    /// variant available on this computer.
    fn described(&self) -> Vec<ModelDescriptor> {
        vec![ModelDescriptor {
            kind: self.kind().to_owned(),
            digest: self.digest(),
            effects: self.effects(),
        }]
    }

    /// Returns whether the simulator handles cases of the given kind (its name in the protocol).
    fn simulates(&self, kind: &str) -> bool {
        kind == self.kind()
    }

    /// Returns the derivatives that every worker computes for the case's reference individual when it joins,
    /// in addition to the curves: one for each way in which this kind of model computes derivatives. Empty if
    /// it gives none.
    fn reference_columns(&self, _case: &Case) -> Vec<Column> {
        Vec::new()
    }

    /// Builds the model of a case.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] naming the field of the case that it cannot be built from.
    fn prepare(&self, case: &Case) -> Result<Box<dyn Model>, Failure>;

    /// Performs a job specific to this kind of model, without a case; only the kind knows the formats of
    /// request and reply.
    ///
    /// # Errors
    /// [`Failure::Refused`] for a name that the kind does not know, [`Failure::Misconfigured`] for a request
    /// that cannot be done.
    fn run_custom(&self, name: &str, body: &[u8]) -> Result<Vec<u8>, Failure>;
}

/// Model of one case, ready for any number of jobs; no job leaves state behind for the next.
pub trait Model: fmt::Debug + Send + Sync {
    /// Simulates an individual, and returns the curves of the condition's channels exactly as computed, with
    /// the derivatives that the job requests: [`protocol::job::Derivative::none`] for a model that gives
    /// none, and no derivatives of a run that fails. Requesting derivatives changes no bit of the curves.
    /// With `scored_only`, only curves of the objective's channels are required; others may be empty.
    ///
    /// # Errors
    /// [`Failure::Misconfigured`] where the job does not fit the case.
    fn observe(&self, spec: &SimulateSpec, scored_only: bool) -> Result<Observation, Failure>;

    /// Simulates an individual, and returns everything that can be plotted; `pictures` is the number of
    /// shapes of the moving bodies to record over the whole run, 0 for none. Derivatives are computed as by
    /// [`Self::observe`]. A model with no curves besides its channels need not override this method.
    ///
    /// # Errors
    /// As [`Self::observe`].
    fn all_curves(&self, spec: &SimulateSpec, _pictures: u32) -> Result<Curves, Failure> {
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

/// Returns the descriptions of all models that a worker simulates, for its announcement.
pub fn described(simulators: Simulators) -> Vec<ModelDescriptor> {
    let all = simulators.iter();
    all.flat_map(|simulator| simulator.described()).collect()
}

/// Returns the simulator for a case, chosen by the case's kind of model.
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
