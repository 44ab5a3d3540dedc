//! Errors of key material (certificates, private keys, list of workers), each with its file and remedy.
use protocol::name::NameError;
use std::path::PathBuf;

/// Reason why key material cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum KeyError {
    /// The folder for key material does not exist.
    #[error("there is no folder {} with key material: `horsehead keys new DIR` makes one", folder.display())]
    NoFolder {
        /// Path of the missing folder as given by the caller.
        folder: PathBuf,
    },
    /// A file of the key material does not exist.
    #[error("{} is missing: {remedy}", path.display())]
    Missing {
        /// Path of the missing file.
        path: PathBuf,
        /// Action that provides the missing file.
        remedy: String,
    },
    /// A file of the key material cannot be read.
    #[error("{} cannot be read: {reason}", path.display())]
    Unreadable {
        /// File that cannot be read.
        path: PathBuf,
        /// Error message of the operating system.
        reason: String,
    },
    /// A file does not contain the expected PEM item.
    #[error("{} holds no {what} in PEM", path.display())]
    NotPem {
        /// File that lacks the expected PEM item.
        path: PathBuf,
        /// PEM item that the file should contain, such as a private key.
        what: &'static str,
    },
    /// Certificate and key do not match.
    #[error("the key beside {} is not the one of that certificate", path.display())]
    Mismatch {
        /// File of the certificate that does not match its key.
        path: PathBuf,
    },
    /// The certificate has expired or is not valid yet.
    #[error("{} {when}: `horsehead keys` makes a new one (and check this machine's clock)", path.display())]
    Date {
        /// File of the certificate that is outside its validity period.
        path: PathBuf,
        /// Part of the error message that states since when the certificate has been expired, or from when it
        /// is valid.
        when: String,
    },
    /// The certificate was signed by another authority.
    #[error("{} was not signed by the authority of {}: both must come from the same `horsehead keys new`", path.display(), ca.display())]
    OtherAuthority {
        /// File of the certificate that another authority signed.
        path: PathBuf,
        /// File of the authority's certificate.
        ca: PathBuf,
    },
    /// The certificate is not suitable for this end of the link.
    #[error("{} cannot be used here: {reason}", path.display())]
    Unfit {
        /// File of the certificate that is not suitable.
        path: PathBuf,
        /// Error message of the verifier.
        reason: String,
    },
    /// A worker's name is not allowed on the bus.
    #[error("{}: {source}", path.display())]
    Name {
        /// File that contains the name.
        path: PathBuf,
        /// Error that states why the name is not allowed.
        source: NameError,
    },
    /// Key material cannot be created or written.
    #[error("{} cannot be made: {reason}", path.display())]
    Make {
        /// File or folder that could not be created.
        path: PathBuf,
        /// Reason why the file or folder could not be created.
        reason: String,
    },
}
