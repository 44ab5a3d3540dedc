//! Options for opening a run.
use journal::event::RunHeader;
use protocol::case::Case;
use std::{path::PathBuf, time::Duration};

/// Options for opening a run.
#[derive(Clone, Debug)]
pub struct DispatchOptions {
    /// Run folder with the journal; created if missing.
    pub run_dir: PathBuf,
    /// Address for workers of other machines; `None` for local workers only.
    pub listen: Option<String>,
    /// Whether the listening address may be unencrypted and open to the network.
    pub insecure: bool,
    /// Folder of the coordinator's key material, for QUIC addresses.
    pub tls: Option<PathBuf>,
    /// Number of worker processes to start on this machine, with one slot each.
    pub local_workers: usize,
    /// Maximum time to wait while the journal cannot be written, or while only jobs are left whose workers were
    /// all lost; then the run ends with the results it has.
    pub pause_limit: Duration,
    /// Case that the jobs simulate.
    pub case: Case,
    /// Command, case and settings that determine the result of the run.
    pub header: RunHeader,
}
