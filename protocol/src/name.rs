//! Name of a worker on the bus: the name of its certificate and the number of its process.
//!
//! Access control knows certificates, so the first part of a name is the certificate's. The second part is
//! drawn at random by each process, so that one certificate may serve any number of processes and a restarted
//! worker has a new name. A [`WorkerId`] is the hash of both: no worker can take the id of a worker with
//! another certificate. This module knows no certificate format.
use crate::id::WorkerId;
use std::fmt;

/// Owner name of workers without a certificate, which connect over loopback.
pub const NO_CERTIFICATE: &str = "anyone";
/// Longest name of an owner (bytes).
pub const OWNER_BYTES: usize = 64;

/// Name of a worker on the bus: name of its certificate and number of its process.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct WorkerName {
    owner: String,
    process: u64,
}

/// Error: a text that cannot be the name of an owner.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "\"{name}\" cannot name a worker: use 1 to {OWNER_BYTES} characters from a-z, 0-9, '-', '_' and '.', beginning \
     with a letter or digit, and not \"{NO_CERTIFICATE}\""
)]
pub struct NameError {
    /// Rejected text, cut to [`OWNER_BYTES`] characters.
    pub name: String,
}

impl WorkerName {
    /// Creates the name of a worker process from the name of its certificate (the owner) and the process's
    /// own number.
    ///
    /// # Errors
    /// [`NameError`] unless [`check_owner`] accepts the owner.
    pub fn of(owner: &str, process: u64) -> Result<Self, NameError> {
        check_owner(owner)?;
        Ok(Self {
            owner: owner.to_owned(),
            process,
        })
    }

    /// Creates the name of a worker process without a certificate.
    pub fn anyone(process: u64) -> Self {
        Self {
            owner: NO_CERTIFICATE.to_owned(),
            process,
        }
    }

    /// Parses a worker's name from the last two parts of a key; `None` if they are not valid.
    pub(crate) fn parse(owner: &str, process: &str) -> Option<Self> {
        (process.len() == 16).then_some(())?;
        let process = u64::from_str_radix(process, 16).ok()?;
        if owner == NO_CERTIFICATE {
            return Some(Self::anyone(process));
        }
        Self::of(owner, process).ok()
    }

    /// Returns the name of the certificate; [`NO_CERTIFICATE`] without one.
    pub fn owner(&self) -> &str {
        &self.owner
    }

    /// Returns the hash of the name, which identifies the worker everywhere but on the bus.
    pub fn id(&self) -> WorkerId {
        let mut first = [0; 8];
        blake3::Hasher::new()
            .update(self.to_string().as_bytes())
            .finalize_xof()
            .fill(&mut first);
        WorkerId(u64::from_le_bytes(first))
    }
}

impl fmt::Display for WorkerName {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(to, "{}/{:016x}", self.owner, self.process)
    }
}

/// Checks whether a certificate's name can be part of a Zenoh key.
///
/// # Errors
/// [`NameError`] if the name is empty, too long, contains characters that are not permitted, or is
/// [`NO_CERTIFICATE`].
pub fn check_owner(name: &str) -> Result<(), NameError> {
    let permitted = |byte: u8| {
        byte.is_ascii_lowercase() || byte.is_ascii_digit() || matches!(byte, b'-' | b'_' | b'.')
    };
    let first = name
        .bytes()
        .next()
        .is_some_and(|b| b.is_ascii_alphanumeric());
    if first && name.len() <= OWNER_BYTES && name.bytes().all(permitted) && name != NO_CERTIFICATE {
        Ok(())
    } else {
        Err(NameError {
            name: name.chars().take(OWNER_BYTES).collect(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn owners_fit_into_keys_and_none_is_anyone() {
        for good in ["worker-01", "a", "node7.rack_2", &"x".repeat(OWNER_BYTES)] {
            assert_eq!(check_owner(good), Ok(()), "{good}");
        }
        for bad in [
            "",
            "anyone",
            "*",
            "a/b",
            "a$*",
            "Worker",
            "-a",
            "über",
            &"x".repeat(65),
        ] {
            assert!(check_owner(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn ids_belong_to_owner_and_process() {
        let one = WorkerName::of("worker-01", 7).unwrap();
        assert_ne!(one.id(), WorkerName::of("worker-01", 8).unwrap().id());
        assert_ne!(one.id(), WorkerName::of("worker-02", 7).unwrap().id());
        assert_ne!(one.id(), WorkerName::anyone(7).id());
        assert_eq!(one.id(), WorkerName::of("worker-01", 7).unwrap().id());
    }
}
