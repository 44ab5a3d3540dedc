//! File names of key material, and the reading of its contents.
use super::error::KeyError;
use protocol::name::check_owner;
use rustls::{
    RootCertStore,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject},
};
use std::{collections::BTreeSet, fs, io, path::Path};

/// File name of the authority's certificate.
pub const CA: &str = "ca.pem";
/// File name of the authority's private key.
pub const CA_KEY: &str = "ca.key";
/// File names of the coordinator's certificate and private key.
pub const COORDINATOR: [&str; 2] = ["coordinator.pem", "coordinator.key"];
/// File names of a worker's certificate and private key.
pub const WORKER: [&str; 2] = ["worker.pem", "worker.key"];
/// File name of the list of workers that may join.
pub const WORKERS: &str = "workers";
/// Role of the owner of key material: coordinator or worker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KeyRole {
    /// Coordinator: listens; its certificate names hosts.
    Coordinator,
    /// Worker: connects; its certificate carries the worker's name.
    Worker,
}

/// Returns the names `worker-01`, `worker-02` and so on, for which a coordinator makes access rules before
/// they are on the list, because these rules are fixed while it runs.
pub fn pool() -> impl Iterator<Item = String> {
    (1..=512).map(|number| format!("worker-{number:02}"))
}

impl KeyRole {
    pub(super) const fn files(self) -> [&'static str; 2] {
        match self {
            Self::Coordinator => COORDINATOR,
            Self::Worker => WORKER,
        }
    }
}

/// Key material in the form that TLS takes: trusted roots, certificate chain and private key.
pub(crate) struct Chain {
    pub(crate) roots: RootCertStore,
    pub(crate) certificates: Vec<CertificateDer<'static>>,
    pub(crate) key: PrivateKeyDer<'static>,
}

/// Reads the certificates of a PEM file.
pub(super) fn certificates(
    path: &Path,
    role: KeyRole,
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

/// Reads a file of the key material; the error for a missing file states the remedy.
pub(super) fn readable(path: &Path, role: KeyRole) -> Result<Vec<u8>, KeyError> {
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

/// Returns the remedy for a missing file; the most frequent cause is that the folder belongs to the other
/// end.
fn remedy(folder: &Path, role: KeyRole) -> String {
    let has = |file: &str| folder.join(file).exists();
    match role {
        KeyRole::Worker if has(WORKERS) => {
            let names = read_workers(&folder.join(WORKERS)).unwrap_or_default();
            let one = names.first().map_or("NAME", String::as_str);
            format!(
                "{} is the coordinator's folder: give that of one worker, as --tls {}",
                folder.display(),
                folder.join(one).display()
            )
        }
        KeyRole::Coordinator if has(WORKER[0]) => format!(
            "{} is a worker's folder: give the one that holds {}",
            folder.display(),
            COORDINATOR[0]
        ),
        KeyRole::Coordinator | KeyRole::Worker => {
            "`horsehead keys new DIR` makes a folder of key material".to_owned()
        }
    }
}

/// Reads the worker names from the file that lists the workers that may join.
pub(super) fn read_workers(path: &Path) -> Result<BTreeSet<String>, KeyError> {
    let bytes = readable(path, KeyRole::Coordinator)?;
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
