//! Key material of one end: where it lies, whom it names, and whether it can be used at all.
//!
//! ```text
//! KEYS/ca.pem            the authority's certificate            (both ends)
//! KEYS/ca.key            its key: signs further workers, needed by nobody at run time
//! KEYS/coordinator.pem   KEYS/coordinator.key                   (coordinator)
//! KEYS/workers           names that may join, one a line        (coordinator)
//! KEYS/NAME/ca.pem       KEYS/NAME/worker.pem   KEYS/NAME/worker.key    (one worker's folder)
//! ```
//!
//! Everything that can be wrong with the files of one end is found here and told by file name,
//! because the transport reports nothing but a time-out. Keys are read and never shown.
pub mod authority;
mod certificate;
mod error;

pub use error::KeyError;

pub(crate) use certificate::{certificate_name, provider};

use certificate::Certificate;
use protocol::name::check_owner;
use rustls::{
    RootCertStore,
    pki_types::{CertificateDer, PrivateKeyDer, pem::PemObject},
};
use std::{
    collections::BTreeSet,
    fs, io,
    path::{Path, PathBuf},
};

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
/// Environment variable: the folder of this end's key material.
pub const FOLDER_VARIABLE: &str = "HORSEHEAD_TLS";

/// Which end the material is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Listens; its certificate names hosts.
    Coordinator,
    /// Dials; its certificate names it.
    Worker,
}

impl Role {
    const fn files(self) -> [&'static str; 2] {
        match self {
            Self::Coordinator => COORDINATOR,
            Self::Worker => WORKER,
        }
    }
}

/// Key material that has been read and checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keys {
    role: Role,
    folder: PathBuf,
    owner: String,
    workers: BTreeSet<String>,
}

/// The parts of key material as TLS takes them.
pub(crate) struct Chain {
    pub(crate) roots: RootCertStore,
    pub(crate) certificates: Vec<CertificateDer<'static>>,
    pub(crate) key: PrivateKeyDer<'static>,
}

impl Keys {
    /// Reads and checks the folder of one end.
    ///
    /// # Errors
    /// [`KeyError`], naming the file and what is wrong with it.
    pub fn read(folder: &Path, role: Role) -> Result<Self, KeyError> {
        let [certificate_file, _] = role.files();
        let mut keys = Self {
            role,
            folder: folder.to_owned(),
            owner: String::new(),
            workers: BTreeSet::new(),
        };
        let chain = keys.chain()?;
        let path = folder.join(certificate_file);
        let certificate = Certificate::parse(&path, &chain.certificates)?;
        certificate.check(role, &chain, &folder.join(CA))?;
        match role {
            Role::Worker => {
                certificate.name.clone_into(&mut keys.owner);
                check_owner(&keys.owner).map_err(|source| KeyError::Name { path, source })?;
            }
            Role::Coordinator => keys.workers = read_workers(&folder.join(WORKERS))?,
        }
        Ok(keys)
    }

    /// The certificate's name, of a worker; empty for a coordinator.
    pub fn owner(&self) -> &str {
        &self.owner
    }

    /// The names that may join, of a coordinator; empty for a worker.
    pub const fn workers(&self) -> &BTreeSet<String> {
        &self.workers
    }

    /// Path of the authority's certificate.
    pub fn ca(&self) -> PathBuf {
        self.folder.join(CA)
    }

    /// Path of this end's certificate.
    pub fn certificate(&self) -> PathBuf {
        self.folder.join(self.role.files()[0])
    }

    /// Path of this end's private key.
    pub fn key(&self) -> PathBuf {
        self.folder.join(self.role.files()[1])
    }

    pub(crate) fn chain(&self) -> Result<Chain, KeyError> {
        if !self.folder.is_dir() {
            return Err(KeyError::NoFolder {
                folder: self.folder.clone(),
            });
        }
        let certificates = certificates(&self.certificate(), self.role)?;
        let path = self.key();
        let pem = readable(&path, self.role)?;
        let key = PrivateKeyDer::from_pem_slice(&pem).map_err(|_| KeyError::NotPem {
            path,
            what: "private key",
        })?;
        let ca = self.ca();
        let mut roots = RootCertStore::empty();
        for certificate in self::certificates(&ca, self.role)? {
            roots.add(certificate).map_err(|_| KeyError::NotPem {
                path: ca.clone(),
                what: "authority",
            })?;
        }
        Ok(Chain {
            roots,
            certificates,
            key,
        })
    }
}

fn certificates(path: &Path, role: Role) -> Result<Vec<CertificateDer<'static>>, KeyError> {
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

fn readable(path: &Path, role: Role) -> Result<Vec<u8>, KeyError> {
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

fn read_workers(path: &Path) -> Result<BTreeSet<String>, KeyError> {
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

#[cfg(test)]
mod tests;
