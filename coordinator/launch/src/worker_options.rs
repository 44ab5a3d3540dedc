//! What every worker is told, wherever it is started.
use link::locator::Locator;
use std::path::PathBuf;

/// What every worker is told, wherever it is started.
#[derive(Clone, Debug)]
pub struct WorkerOptions {
    /// Where it dials.
    pub connect: Locator,
    /// The coordinator's folder of key material; none for `tcp/`.
    pub tls: Option<PathBuf>,
    /// It ends after so long without work \[s\]; none for never.
    pub idle_timeout: Option<u64>,
    /// Simulations at a time; none for one per hardware thread.
    pub slots: Option<u16>,
    /// Lines of shell that come before it, as `module load`.
    pub prologue: String,
    /// Name of the run that launches it and ends it; empty where a person does.
    pub owner: String,
}

impl WorkerOptions {
    /// The arguments of the worker, but for its program and its keys.
    pub(super) fn arguments(&self) -> Vec<String> {
        let mut all = vec!["--connect".to_owned(), self.connect.to_string()];
        let mut option = |name: &str, value: Option<u64>| {
            all.extend(
                value
                    .into_iter()
                    .flat_map(|v| [name.to_owned(), v.to_string()]),
            );
        };
        option("--slots", self.slots.map(u64::from));
        option("--idle-timeout", self.idle_timeout);
        all
    }
}
