//! Creation of key material: a certificate authority and the certificates that it signs.
//!
//! Keys are ECDSA P-256, made and kept on the machine that runs this code; files with a private key are
//! readable by their owner only. A coordinator's certificate is valid for serving only and a worker's for
//! connecting only, so that a stolen worker's key cannot impersonate the coordinator.
use super::certificate::Certificate;
use super::error::KeyError;
use super::material::{CA, CA_KEY, COORDINATOR, KeyRole, WORKER, WORKERS, readable};
use protocol::{id::ContentHash, name::check_owner};
use rcgen::{
    BasicConstraints, CertificateParams, DistinguishedName, DnType, ExtendedKeyUsagePurpose, IsCa,
    Issuer, KeyPair, KeyUsagePurpose, date_time_ymd,
};
use rustls::pki_types::{CertificateDer, pem::PemObject};
use std::{
    fs::{self, File, OpenOptions},
    io::{self, Write},
    os::unix::fs::{DirBuilderExt, OpenOptionsExt},
    path::{Path, PathBuf},
    time::{Duration, SystemTime, UNIX_EPOCH},
};

/// Backdating of a certificate's start of validity, because the clocks of a cluster differ.
const BACKDATED: Duration = Duration::from_hours(24);
/// Validity of an authority's certificate.
const AUTHORITY_VALID: Duration = Duration::from_hours(24 * 3650);

/// Validity period of a certificate to be created.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Validity {
    /// Start of the certificate's validity.
    pub from: SystemTime,
    /// End of the certificate's validity.
    pub until: SystemTime,
}

impl Validity {
    /// Returns a period from one day ago, because clocks differ, until `days` from now.
    pub fn days(days: u32) -> Self {
        let now = SystemTime::now();
        Self {
            from: now.checked_sub(BACKDATED).unwrap_or(UNIX_EPOCH),
            until: now + Duration::from_hours(24 * u64::from(days)),
        }
    }
}

/// Certificate authority whose files are stored in a folder.
#[derive(Debug)]
pub struct Authority {
    folder: PathBuf,
    params: CertificateParams,
    key: KeyPair,
    pem: String,
}

impl Authority {
    /// Creates a certificate authority in a new or empty folder.
    ///
    /// # Errors
    /// [`KeyError::Make`] if the folder is not empty or cannot be written.
    pub fn create(folder: &Path) -> Result<Self, KeyError> {
        let make = |reason: String| KeyError::Make {
            path: folder.to_owned(),
            reason,
        };
        if fs::read_dir(folder).is_ok_and(|mut entries| entries.next().is_some()) {
            return Err(make(
                "the folder is not empty; nothing was written, choose another one".to_owned(),
            ));
        }
        folder_of_ones_own(folder)?;
        let made = Self::generate(folder)?;
        write(&folder.join(CA), &made.pem, Open::All)?;
        write(&folder.join(CA_KEY), &made.key.serialize_pem(), Open::Owner)?;
        Ok(made)
    }

    fn generate(folder: &Path) -> Result<Self, KeyError> {
        let make = |error: rcgen::Error| KeyError::Make {
            path: folder.to_owned(),
            reason: error.to_string(),
        };
        let key = KeyPair::generate().map_err(make)?;
        // tells authorities apart for people; machines go by the key
        let mark = ContentHash::of(key.public_key_raw()).to_string();
        let mark: String = mark.chars().take(8).collect();
        let params = authority_params(&format!("horsehead authority {mark}"));
        let pem = params.self_signed(&key).map_err(make)?.pem();
        Ok(Self {
            folder: folder.to_owned(),
            params,
            key,
            pem,
        })
    }

    /// Opens the authority stored in a folder, to sign further certificates.
    ///
    /// # Errors
    /// [`KeyError`] if its certificate or key is missing or cannot be read.
    pub fn open(folder: &Path) -> Result<Self, KeyError> {
        let read = |file: &str| {
            let path = folder.join(file);
            let pem = readable(&path, KeyRole::Coordinator)?;
            String::from_utf8(pem).map_err(|_| KeyError::NotPem { path, what: "text" })
        };
        let (pem, key) = (read(CA)?, read(CA_KEY)?);
        let not = |file: &str, what| KeyError::NotPem {
            path: folder.join(file),
            what,
        };
        let key = KeyPair::from_pem(&key).map_err(|_| not(CA_KEY, "private key"))?;
        let der =
            CertificateDer::from_pem_slice(pem.as_bytes()).map_err(|_| not(CA, "certificate"))?;
        let name = Certificate::parse(&folder.join(CA), &[der])?.name;
        Ok(Self {
            folder: folder.to_owned(),
            params: authority_params(&name),
            key,
            pem,
        })
    }

    /// Writes the coordinator's certificate and key, replacing existing ones; `hosts` are the names and
    /// addresses to which workers connect.
    ///
    /// # Errors
    /// [`KeyError::Make`] if a host is not a valid name, or a file cannot be written.
    pub fn issue_coordinator(&self, hosts: &[String], valid: Validity) -> Result<(), KeyError> {
        let [certificate, key] = COORDINATOR.map(|file| self.folder.join(file));
        let pair = self.pair_for_coordinator(hosts, valid)?;
        let [new_certificate, new_key] =
            [&certificate, &key].map(|file| file.with_extension("new"));
        // what a process left that was killed here
        for file in [&new_certificate, &new_key] {
            drop(fs::remove_file(file));
        }
        write(&new_key, &pair.1, Open::Owner)?;
        replace(&new_key, &key)?;
        write(&new_certificate, &pair.0, Open::All)?;
        replace(&new_certificate, &certificate)
    }

    /// Makes a coordinator's certificate and key, both in PEM.
    pub(crate) fn pair_for_coordinator(
        &self,
        hosts: &[String],
        valid: Validity,
    ) -> Result<(String, String), KeyError> {
        let params = leaf(
            "coordinator",
            hosts,
            ExtendedKeyUsagePurpose::ServerAuth,
            valid,
        );
        let params = params.map_err(|error| KeyError::Make {
            path: self.folder.join(COORDINATOR[0]),
            reason: format!("{}: {error}", hosts.join(", ")),
        })?;
        self.sign(&params)
    }

    /// Makes a worker's certificate and key, both in PEM.
    pub(crate) fn pair_for_worker(
        &self,
        name: &str,
        valid: Validity,
    ) -> Result<(String, String), KeyError> {
        let params = leaf(name, &[], ExtendedKeyUsagePurpose::ClientAuth, valid);
        self.sign(&params.map_err(|error| self.failed(&error))?)
    }

    /// Returns the authority's certificate in PEM.
    pub(crate) fn pem(&self) -> &str {
        &self.pem
    }

    /// Creates the folder of one worker and adds its name to the list of workers that may join; returns the
    /// folder.
    ///
    /// # Errors
    /// [`KeyError::Name`] if the name is not valid; [`KeyError::Make`] if the worker exists or a file cannot
    /// be written.
    pub fn issue_worker(&self, name: &str, valid: Validity) -> Result<PathBuf, KeyError> {
        let list = self.folder.join(WORKERS);
        check_owner(name).map_err(|source| KeyError::Name {
            path: list.clone(),
            source,
        })?;
        let folder = self.folder.join(name);
        if folder.exists() {
            return Err(KeyError::Make {
                path: folder,
                reason: "it exists already; nothing was written".to_owned(),
            });
        }
        folder_of_ones_own(&folder)?;
        let [certificate, key] = WORKER.map(|file| folder.join(file));
        save(&self.pair_for_worker(name, valid)?, &certificate, &key)?;
        write(&folder.join(CA), &self.pem, Open::All)?;
        add_name(&list, name).map_err(|error| KeyError::Make {
            path: list,
            reason: error.to_string(),
        })?;
        Ok(folder)
    }

    fn sign(&self, params: &CertificateParams) -> Result<(String, String), KeyError> {
        let pair = KeyPair::generate().map_err(|error| self.failed(&error))?;
        let issuer = Issuer::from_params(&self.params, &self.key);
        let signed = params.signed_by(&pair, &issuer);
        let signed = signed.map_err(|error| self.failed(&error))?;
        Ok((signed.pem(), pair.serialize_pem()))
    }

    fn failed(&self, error: &rcgen::Error) -> KeyError {
        KeyError::Make {
            path: self.folder.clone(),
            reason: error.to_string(),
        }
    }
}

/// Creates a certificate authority that is kept in memory only.
pub(crate) fn for_memory() -> Result<Authority, KeyError> {
    Authority::generate(Path::new("the inner certificates"))
}

/// Adds a line to the list of workers. The list is replaced as a whole, since coordinators read it meanwhile, and
/// under a lock of its folder, since several processes may add names at the same time.
fn add_name(list: &Path, name: &str) -> io::Result<()> {
    let list = fs::canonicalize(list).unwrap_or_else(|_| list.to_owned());
    let folder = list.parent().filter(|path| !path.as_os_str().is_empty());
    let folder = File::open(folder.unwrap_or(Path::new(".")))?;
    folder.lock()?;
    let mut names = match fs::read_to_string(&list) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => String::new(),
        read => read?,
    };
    if !names.is_empty() && !names.ends_with('\n') {
        names.push('\n');
    }
    names.push_str(name);
    names.push('\n');
    let new = list.with_extension("new");
    let mut file = File::create(&new)?;
    if let Ok(there) = fs::metadata(&list) {
        file.set_permissions(there.permissions())?;
    }
    file.write_all(names.as_bytes())?;
    file.sync_all()?;
    fs::rename(&new, &list)?;
    // a child that is being started may hold the folder open for a moment
    folder.unlock()
}

fn save((certificate, key): &(String, String), to: &Path, key_to: &Path) -> Result<(), KeyError> {
    write(key_to, key, Open::Owner)?;
    write(to, certificate, Open::All)
}

fn replace(new: &Path, old: &Path) -> Result<(), KeyError> {
    fs::rename(new, old).map_err(|error| KeyError::Make {
        path: old.to_owned(),
        reason: error.to_string(),
    })
}

fn authority_params(name: &str) -> CertificateParams {
    let mut params = CertificateParams::default();
    params.distinguished_name = named(name);
    params.is_ca = IsCa::Ca(BasicConstraints::Constrained(0));
    params.key_usages = vec![KeyUsagePurpose::KeyCertSign, KeyUsagePurpose::CrlSign];
    let now = SystemTime::now();
    set_validity(
        &mut params,
        Validity {
            from: now.checked_sub(BACKDATED).unwrap_or(UNIX_EPOCH),
            until: now + AUTHORITY_VALID,
        },
    );
    params
}

fn leaf(
    name: &str,
    hosts: &[String],
    purpose: ExtendedKeyUsagePurpose,
    valid: Validity,
) -> Result<CertificateParams, rcgen::Error> {
    let mut params = CertificateParams::new(hosts)?;
    params.distinguished_name = named(name);
    params.is_ca = IsCa::ExplicitNoCa;
    params.key_usages = vec![KeyUsagePurpose::DigitalSignature];
    params.extended_key_usages = vec![purpose];
    params.use_authority_key_identifier_extension = true;
    set_validity(&mut params, valid);
    Ok(params)
}

fn named(name: &str) -> DistinguishedName {
    let mut distinguished = DistinguishedName::new();
    distinguished.push(DnType::CommonName, name);
    distinguished
}

fn set_validity(params: &mut CertificateParams, valid: Validity) {
    let at = |time: SystemTime| {
        let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
        date_time_ymd(1970, 1, 1) + Duration::from_secs(since.as_secs())
    };
    params.not_before = at(valid.from);
    params.not_after = at(valid.until);
}

/// Read permission of a file: all users, or its owner only.
#[derive(Clone, Copy)]
enum Open {
    All,
    Owner,
}

fn write(path: &Path, text: &str, open: Open) -> Result<(), KeyError> {
    let mode = match open {
        Open::All => 0o644,
        Open::Owner => 0o600,
    };
    OpenOptions::new()
        .write(true)
        .create_new(true)
        .mode(mode)
        .open(path)
        .and_then(|mut file| file.write_all(text.as_bytes()))
        .map_err(|error| KeyError::Make {
            path: path.to_owned(),
            reason: error.to_string(),
        })
}

fn folder_of_ones_own(folder: &Path) -> Result<(), KeyError> {
    fs::DirBuilder::new()
        .recursive(true)
        .mode(0o700)
        .create(folder)
        .map_err(|error| KeyError::Make {
            path: folder.to_owned(),
            reason: error.to_string(),
        })
}
