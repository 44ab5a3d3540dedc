//! Options common to all workers, whichever launcher starts them.
use link::locator::Locator;
use std::path::PathBuf;

/// Options passed to every launched worker.
#[derive(Clone, Debug)]
pub struct WorkerOptions {
    /// Address of the coordinator to connect to.
    pub connect: Locator,
    /// Coordinator's folder of key material for TLS; `None` for an unencrypted `tcp/` address.
    pub tls: Option<PathBuf>,
    /// Time without work after which the worker ends \[s\]; `None` for never.
    pub idle_timeout: Option<u64>,
    /// Number of simulations at a time; `None` for one per hardware thread.
    pub slots: Option<u16>,
    /// Shell lines run before the worker starts, such as `module load`.
    pub prologue: String,
    /// Name of the run that launches and ends the worker; empty if a user does.
    pub owner: String,
}

impl WorkerOptions {
    /// Returns the worker's command-line arguments, without program and keys.
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
