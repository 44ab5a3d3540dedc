//! Key material of one end of a link: files, names and checks.
//!
//! ```text
//! KEYS/ca.pem            the authority's certificate            (both ends)
//! KEYS/ca.key            its key: signs further workers, not needed at run time
//! KEYS/coordinator.pem   KEYS/coordinator.key                   (coordinator)
//! KEYS/workers           names that may join, one a line        (coordinator)
//! KEYS/NAME/ca.pem       KEYS/NAME/worker.pem   KEYS/NAME/worker.key    (one worker's folder)
//! ```
//!
//! All faults in the files of one end are detected here and reported by file name, because the transport
//! reports nothing but a time-out. Keys are read and never displayed.
pub mod authority;
mod certificate;
mod error;
mod material;

pub use error::KeyError;
pub use material::{CA, CA_KEY, COORDINATOR, KeyRole, WORKER, WORKERS, pool};

pub(crate) use certificate::{certificate_name, provider};

use certificate::Certificate;
use material::{Chain, certificates, read_workers, readable};
use protocol::name::check_owner;
use rustls::{
    RootCertStore,
    pki_types::{PrivateKeyDer, pem::PemObject},
};
use std::{
    collections::BTreeSet,
    path::{Path, PathBuf},
};

/// Environment variable with the path of the key folder of this coordinator or worker.
pub const FOLDER_VARIABLE: &str = "HORSEHEAD_TLS";

/// Key material (certificates, private key, names) of a coordinator or worker, read and checked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keys {
    role: KeyRole,
    folder: PathBuf,
    owner: String,
    workers: BTreeSet<String>,
}

impl Keys {
    /// Reads and checks the key folder of a coordinator or a worker.
    ///
    /// # Errors
    /// [`KeyError`], which names the file and the fault.
    pub fn read(folder: &Path, role: KeyRole) -> Result<Self, KeyError> {
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
            KeyRole::Worker => {
                certificate.name.clone_into(&mut keys.owner);
                check_owner(&keys.owner).map_err(|source| KeyError::Name { path, source })?;
            }
            KeyRole::Coordinator => keys.workers = read_workers(&folder.join(WORKERS))?,
        }
        Ok(keys)
    }

    /// Returns the common name of a worker's certificate; empty for a coordinator.
    pub fn owner(&self) -> &str {
        &self.owner
    }

    /// Returns the names of the workers that may join; empty for a worker's keys.
    pub const fn workers(&self) -> &BTreeSet<String> {
        &self.workers
    }

    /// Reads the list of workers that may join again, because users edit its file during a run.
    pub(crate) fn workers_now(&self) -> Result<BTreeSet<String>, KeyError> {
        read_workers(&self.folder.join(WORKERS))
    }

    /// Returns the path of the authority's certificate.
    pub fn ca(&self) -> PathBuf {
        self.folder.join(CA)
    }

    /// Returns the path of this end's certificate.
    pub fn certificate(&self) -> PathBuf {
        self.folder.join(self.role.files()[0])
    }

    /// Returns the path of this end's private key.
    pub fn key(&self) -> PathBuf {
        self.folder.join(self.role.files()[1])
    }

    pub(crate) fn chain(&self) -> Result<Chain, KeyError> {
        if !self.folder.is_dir() {
            return Err(KeyError::NoFolder {
                folder: self.folder.clone(),
            });
        }
        let own = certificates(&self.certificate(), self.role)?;
        let path = self.key();
        let pem = readable(&path, self.role)?;
        let key = PrivateKeyDer::from_pem_slice(&pem).map_err(|_| KeyError::NotPem {
            path,
            what: "private key",
        })?;
        let ca = self.ca();
        let mut roots = RootCertStore::empty();
        for certificate in certificates(&ca, self.role)? {
            roots.add(certificate).map_err(|_| KeyError::NotPem {
                path: ca.clone(),
                what: "authority",
            })?;
        }
        Ok(Chain {
            roots,
            certificates: own,
            key,
        })
    }
}

#[cfg(test)]
mod tests;
