//! Simulator for external programs: one kind of model for each program that this computer allows.
use super::model::Prepared;
use crate::simulator::{Model, Simulator};
use exchange::allow::{self, AllowEntry, Allowed};
use protocol::{
    announce::{EffectDescriptor, ModelDescriptor},
    case::Case,
    external::{External, KIND, entry_of, kind_of},
    id::ContentHash,
    job::Failure,
};
use std::{
    process::{Command, Stdio},
    sync::OnceLock,
};

/// Simulator of the external programs that this computer allows to be started.
#[derive(Clone, Copy, Debug)]
pub struct Externals;

impl Simulator for Externals {
    fn kind(&self) -> &'static str {
        KIND
    }

    fn digest(&self) -> String {
        ContentHash::of(KIND.as_bytes()).to_string()
    }

    fn effects(&self) -> Vec<EffectDescriptor> {
        Vec::new()
    }

    fn described(&self) -> Vec<ModelDescriptor> {
        static DESCRIBED: OnceLock<Vec<ModelDescriptor>> = OnceLock::new();
        DESCRIBED.get_or_init(described).clone()
    }

    fn simulates(&self, kind: &str) -> bool {
        entry_of(kind).is_some()
    }

    fn prepare(&self, case: &Case) -> Result<Box<dyn Model>, Failure> {
        let name = entry_of(&case.model.kind).unwrap_or_default();
        let path = allow::path();
        let problem = |text: String| Failure::Refused { reason: text };
        let allowed = allow::read(&path).map_err(|error| problem(error.to_string()))?;
        let entry = allowed.entry.get(name).ok_or_else(|| {
            problem(format!(
                "{} has no entry `{name}`: `horsehead allow CASE` on this machine writes it",
                path.display()
            ))
        })?;
        let external = External::of(&case.model)
            .map_err(|error| Failure::misconfigured("model", error.to_string()))?;
        let files = external.digest();
        if entry.files.as_ref().is_some_and(|own| *own != files) {
            return Err(problem(format!(
                "the case's files are not those that entry `{name}` of {} was allowed for: look at what has \
                 changed, then `horsehead allow CASE`",
                path.display()
            )));
        }
        Ok(Box::new(Prepared::new(
            case,
            external,
            entry.clone(),
            name,
        )?))
    }

    fn run_custom(&self, name: &str, _: &[u8]) -> Result<Vec<u8>, Failure> {
        Err(Failure::Refused {
            reason: format!("an external program does not support the job `{name}`"),
        })
    }
}

/// Returns a description of each entry in the list of allowed programs, for the worker's announcement; runs
/// the version command of each entry, which may take time.
fn described() -> Vec<ModelDescriptor> {
    let allowed = allow::read(&allow::path()).unwrap_or_else(|problem| {
        tracing::warn!("the list of allowed programs cannot be read, so no external program will be started: {problem}");
        Allowed::default()
    });
    let entries = allowed.entry.iter();
    let described = entries.map(|(name, entry)| ModelDescriptor {
        kind: kind_of(name),
        digest: digest(entry),
        effects: Vec::new(),
    });
    described.collect()
}

/// Returns a digest of the output of a program's version command, or of nothing without such a command, to
/// distinguish computers with different versions of the program.
fn digest(entry: &AllowEntry) -> String {
    let said = entry.version.split_first().map(|(program, arguments)| {
        let output = Command::new(program)
            .args(arguments)
            .stdin(Stdio::null())
            .output();
        match output {
            Ok(output) => [output.stdout, output.stderr].concat(),
            Err(error) => error.to_string().into_bytes(),
        }
    });
    ContentHash::of(&said.unwrap_or_default()).to_string()
}
