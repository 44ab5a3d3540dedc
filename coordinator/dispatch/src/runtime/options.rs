//! Options for opening a run.
use super::{
    PAUSE_LIMIT,
    divide::{Divide, Undivided},
};
use journal::event::RunHeader;
use protocol::{
    case::Case,
    id::ContentHash,
    wire::{self, WireError},
};
use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::Duration,
};

/// Access for workers of other machines; none by default.
#[derive(Clone, Debug, Default)]
pub struct RemoteAccess {
    /// Address at which they may connect; `None` for local workers only.
    pub listen: Option<String>,
    /// Folder of the coordinator's key material, for QUIC addresses.
    pub tls: Option<PathBuf>,
    /// Whether the address may be unencrypted and open to the network.
    pub insecure: bool,
}

/// Options for opening a run.
#[derive(Clone, Debug)]
pub struct DispatchOptions {
    /// Run folder with the journal; created if missing.
    pub run_dir: PathBuf,
    /// Access for workers of other machines.
    pub access: RemoteAccess,
    /// Number of worker processes to start on this machine, with one slot each.
    pub local_workers: usize,
    /// Maximum time to wait while the journal cannot be written, or while only jobs are left whose workers were
    /// all lost; then the run ends with the results it has.
    pub pause_limit: Duration,
    /// Division of jobs into parts for slots that would be idle.
    pub divide: Arc<dyn Divide>,
    /// Case that the jobs simulate.
    pub case: Case,
    /// Command, case and settings that determine the result of the run.
    pub header: RunHeader,
}

impl DispatchOptions {
    /// Creates the options of a run of a case that only workers on this machine can join, whose jobs stay whole. `kind` names the command,
    /// `settings` is the canonical JSON of what else determines the result.
    ///
    /// # Errors
    /// [`WireError`] if the case cannot be encoded.
    pub fn local(
        run_dir: &Path,
        local_workers: usize,
        case: &Case,
        kind: &str,
        settings: String,
    ) -> Result<Self, WireError> {
        Ok(Self {
            run_dir: run_dir.to_owned(),
            access: RemoteAccess::default(),
            local_workers,
            pause_limit: PAUSE_LIMIT,
            divide: Arc::new(Undivided),
            case: case.clone(),
            header: RunHeader {
                kind: kind.to_owned(),
                case: ContentHash::of(&wire::encode(case)?),
                settings,
            },
        })
    }
}
