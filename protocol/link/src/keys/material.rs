//! The files of key material: what they are called, and what is in them.
use super::error::KeyError;
use protocol::name::check_owner;
use rustls::{
    RootCertStore,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject},
};
use std::{collections::BTreeSet, fs, io, path::Path};

/// File of the authority's certificate.
pub const CA: &str = "ca.pem";
/// File of the authority's key.
pub const CA_KEY: &str = "ca.key";
/// Files of the coordinator: certificate and key.
pub const COORDINATOR: [&str; 2] = ["coordinator.pem", "coordinator.key"];
/// Files of a worker: certificate and key.
pub const WORKER: [&str; 2] = ["worker.pem", "worker.key"];
/// File of the names that may join.
pub const WORKERS: &str = "workers";
/// Which end the material is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Listens; its certificate names hosts.
    Coordinator,
    /// Dials; its certificate names it.
    Worker,
}

/// Names that a coordinator makes room for before they are on the list, since its rules of access are
/// fixed while it runs: `worker-01`, `worker-02` and so on.
pub fn pool() -> impl Iterator<Item = String> {
    (1..=512).map(|number| format!("worker-{number:02}"))
}

impl Role {
    pub(super) const fn files(self) -> [&'static str; 2] {
        match self {
            Self::Coordinator => COORDINATOR,
            Self::Worker => WORKER,
        }
    }
}

/// The parts of key material as TLS takes them.
pub(crate) struct Chain {
    pub(crate) roots: RootCertStore,
    pub(crate) certificates: Vec<CertificateDer<'static>>,
    pub(crate) key: PrivateKeyDer<'static>,
}

/// The certificates of a file.
pub(super) fn certificates(
    path: &Path,
    role: Role,
) -> Result<Vec<CertificateDer<'static>>, KeyError> {
    let pem = readable(path, role)?;
    let not = || KeyError::NotPem {
        path: path.to_owned(),
        what: "certificate",
    };
    let found: Vec<_> = CertificateDer::pem_slice_iter(&pem)
        .collect::<Result<_, _>>()
        .map_err(|_| not())?;
    if found.is_empty() {
        Err(not())
    } else {
        Ok(found)
    }
}

/// What a file holds; what to do if it is not there.
pub(super) fn readable(path: &Path, role: Role) -> Result<Vec<u8>, KeyError> {
    fs::read(path).map_err(|error| {
        let path = path.to_owned();
        if error.kind() == io::ErrorKind::NotFound {
            let remedy = remedy(path.parent().unwrap_or(Path::new("")), role);
            KeyError::Missing { path, remedy }
        } else {
            let reason = error.to_string();
            KeyError::Unreadable { path, reason }
        }
    })
}

/// What to do about a file that is not there: most often the folder is the other end's.
fn remedy(folder: &Path, role: Role) -> String {
    let has = |file: &str| folder.join(file).exists();
    match role {
        Role::Worker if has(WORKERS) => {
            let names = read_workers(&folder.join(WORKERS)).unwrap_or_default();
            let one = names.first().map_or("NAME", String::as_str);
            format!(
                "{} is the coordinator's folder: give that of one worker, as --tls {}",
                folder.display(),
                folder.join(one).display()
            )
        }
        Role::Coordinator if has(WORKER[0]) => format!(
            "{} is a worker's folder: give the one that holds {}",
            folder.display(),
            COORDINATOR[0]
        ),
        Role::Coordinator | Role::Worker => {
            "`horsehead keys new DIR` makes a folder of key material".to_owned()
        }
    }
}

/// The names of a list of workers.
pub(super) fn read_workers(path: &Path) -> Result<BTreeSet<String>, KeyError> {
    let bytes = readable(path, Role::Coordinator)?;
    let text = String::from_utf8_lossy(&bytes);
    let names = text.lines().map(str::trim);
    names
        .filter(|line| !line.is_empty() && !line.starts_with('#'))
        .map(|name| match check_owner(name) {
            Ok(()) => Ok(name.to_owned()),
            Err(source) => Err(KeyError::Name {
                path: path.to_owned(),
                source,
            }),
        })
        .collect()
}
