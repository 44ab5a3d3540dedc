//! What a run is opened with.
use protocol::{case::Case, event::RunHeader};
use std::{path::PathBuf, time::Duration};

/// The usual pause limit: long enough for a person who is told to make room.
pub const PAUSE_LIMIT: Duration = Duration::from_mins(10);

/// What a run is opened with.
#[derive(Clone, Debug)]
pub struct DispatchOptions {
    /// Folder of the run's journal; made if it is not there.
    pub run_dir: PathBuf,
    /// Address for workers of other machines; `None` for local workers only.
    pub listen: Option<String>,
    /// Whether that address may be unencrypted and open to the network.
    pub insecure: bool,
    /// Folder of the coordinator's key material, for QUIC addresses.
    pub tls: Option<PathBuf>,
    /// Worker processes to start on this machine, with one slot each.
    pub local_workers: usize,
    /// Longest time for which the run waits while its journal cannot be written; then it ends with what it has.
    pub pause_limit: Duration,
    /// What the jobs are about.
    pub case: Case,
    /// What decides the result of the run.
    pub header: RunHeader,
}
