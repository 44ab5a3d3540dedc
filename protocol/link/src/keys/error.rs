//! What can be wrong with key material, by file, and what to do about it.
use protocol::name::NameError;
use std::path::PathBuf;

/// Why key material cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyError {
    /// The folder is not there.
    #[error("there is no folder {} with key material: `horsehead keys new DIR` makes one", folder.display())]
    NoFolder {
        /// As given.
        folder: PathBuf,
    },
    /// A file is not there.
    #[error("{} is missing: {remedy}", path.display())]
    Missing {
        /// Which.
        path: PathBuf,
        /// What to do.
        remedy: String,
    },
    /// A file cannot be read.
    #[error("{} cannot be read: {reason}", path.display())]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// A file does not hold what it should.
    #[error("{} holds no {what} in PEM", path.display())]
    NotPem {
        /// Which.
        path: PathBuf,
        /// What it should hold.
        what: &'static str,
    },
    /// Certificate and key are not a pair.
    #[error("the key beside {} is not the one of that certificate", path.display())]
    Mismatch {
        /// The certificate.
        path: PathBuf,
    },
    /// The certificate is out of date, or not yet valid.
    #[error("{} {when}: `horsehead keys` makes a new one (and check this machine's clock)", path.display())]
    Date {
        /// The certificate.
        path: PathBuf,
        /// Since or from when.
        when: String,
    },
    /// The certificate was signed by somebody else.
    #[error("{} was not signed by the authority of {}: both must come from the same `horsehead keys new`", path.display(), ca.display())]
    OtherAuthority {
        /// The certificate.
        path: PathBuf,
        /// The authority's.
        ca: PathBuf,
    },
    /// The certificate is not made for this end.
    #[error("{} cannot be used here: {reason}", path.display())]
    Unfit {
        /// The certificate.
        path: PathBuf,
        /// The verifier's words.
        reason: String,
    },
    /// A name cannot be used on the bus.
    #[error("{}: {source}", path.display())]
    Name {
        /// Where the name stands.
        path: PathBuf,
        /// What is wrong with it.
        source: NameError,
    },
    /// Key material cannot be made or written.
    #[error("{} cannot be made: {reason}", path.display())]
    Make {
        /// Which file or folder.
        path: PathBuf,
        /// Why not.
        reason: String,
    },
}
