//! Arguments that let workers on other machines connect.
use clap::Args;
use std::path::PathBuf;

/// Access for workers on other machines; none by default.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct RemoteAccess {
    /// Where workers on other machines may connect, as `quic/0.0.0.0:7447`.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_LISTEN")]
    pub(crate) listen: Option<String>,
    /// Folder of certificates for `quic/` addresses, as `horsehead keys new` makes it.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    pub(crate) tls: Option<PathBuf>,
    /// Allow other machines to connect without certificates.
    #[arg(long, env = "HORSEHEAD_INSECURE")]
    pub(crate) insecure: bool,
}
