//! Listening addresses of a run, their key material, and checks before the run starts.
use super::{error::DispatchError, options::DispatchOptions};
use link::{
    LinkError,
    keys::{KeyRole, Keys},
    locator::{Locator, Protocol},
};
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use std::{
    env,
    fs::{self, Permissions},
    io,
    os::unix::fs::{MetadataExt as _, PermissionsExt as _},
    path::PathBuf,
};
use tempfile::TempDir;

/// Number of open files to request; more is useless, since the link limits its connections.
const FILES: u64 = 16 << 10;

/// Raises this process's limit of open files: the usual limit of about a thousand could be used up by a few
/// silent peers.
pub fn allow_connections() {
    let Rlimit { current, maximum } = getrlimit(Resource::Nofile);
    let wanted = maximum.map_or(FILES, |maximum| maximum.min(FILES));
    if current.is_none_or(|current| current >= wanted) {
        return;
    }
    let limit = Rlimit {
        current: Some(wanted),
        maximum,
    };
    if let Err(error) = setrlimit(Resource::Nofile, limit) {
        tracing::debug!(%error, "the limit of open files cannot be raised");
    }
}

/// Checks that listening on an address is permitted (authenticated, or insecure listening allowed) and possible,
/// before anything is created or started.
pub(super) fn admissible(locator: &Locator, insecure: bool) -> Result<(), DispatchError> {
    locator.permit(insecure)?;
    locator
        .try_listen()
        .map_err(|source| DispatchError::Listen {
            locator: locator.to_string(),
            source,
        })
}

/// Reads and checks the key material if an address needs it.
pub(super) fn keys(
    options: &DispatchOptions,
    listen: &[Locator],
) -> Result<Option<Keys>, DispatchError> {
    let Some(secured) = listen.iter().find(|at| at.protocol == Protocol::Quic) else {
        return Ok(None);
    };
    let folder = options
        .access
        .tls
        .as_ref()
        .ok_or_else(|| LinkError::NoKeys {
            locator: secured.to_string(),
        })?;
    let keys = Keys::read(folder, KeyRole::Coordinator).map_err(LinkError::from)?;
    Ok(Some(keys))
}

/// Addresses of a run.
pub(super) struct Addresses {
    /// Addresses to listen on, that for other workers first.
    pub(super) listen: Vec<Locator>,
    /// Address of local workers: a Unix socket, for which they need no certificates.
    pub(super) local: Option<Locator>,
    /// Folder of the Unix socket, if it was made for this run.
    pub(super) folder: Option<TempDir>,
}

/// Determines the addresses to listen on, and makes the folder of the Unix socket for local workers.
pub(super) fn addresses(options: &DispatchOptions) -> Result<Addresses, DispatchError> {
    let asked = options
        .access
        .listen
        .as_deref()
        .map(Locator::parse)
        .transpose()?;
    if options.local_workers == 0 {
        let listen = vec![asked.ok_or(DispatchError::NoWorkers)?];
        let (local, folder) = (None, None);
        return Ok(Addresses {
            listen,
            local,
            folder,
        });
    }
    if let Some(asked) = asked.clone().filter(|at| at.protocol == Protocol::Unix) {
        return Ok(Addresses {
            listen: vec![asked.clone()],
            local: Some(asked),
            folder: None,
        });
    }
    let (folder, local) = local_socket().map_err(DispatchError::Socket)?;
    Ok(Addresses {
        listen: asked.into_iter().chain([local.clone()]).collect(),
        local: Some(local),
        folder: Some(folder),
    })
}

/// Makes a folder that other users cannot enter, below `$XDG_RUNTIME_DIR` or the folder for temporary files; returns
/// it with the address of a Unix socket in it.
///
/// # Errors
/// The error of the operating system for the last of these parents.
pub fn local_socket() -> io::Result<(TempDir, Locator)> {
    // whoever owns a folder can replace what is in it
    let is_own = |path: &PathBuf| {
        let own = rustix::process::geteuid().as_raw();
        fs::metadata(path).is_ok_and(|found| found.uid() == own)
    };
    let runtime = env::var_os("XDG_RUNTIME_DIR").map(PathBuf::from);
    let runtime = runtime.filter(is_own);
    let usual = [runtime, Some(env::temp_dir()), Some(PathBuf::from("/tmp"))];
    let mut last = io::Error::from(io::ErrorKind::NotFound);
    for parent in usual.into_iter().flatten() {
        let made = tempfile::Builder::new()
            .prefix("horsehead-")
            .permissions(Permissions::from_mode(0o700))
            .tempdir_in(&parent)
            .and_then(|folder| {
                let path = std::path::absolute(folder.path().join("bus"))?;
                let at = Locator::socket(&path).map_err(io::Error::other)?;
                Ok((folder, at))
            });
        match made {
            Ok(made) => return Ok(made),
            Err(error) => last = error,
        }
    }
    Err(last)
}
