//! Arguments that let workers on other machines connect.
use clap::Args;
use dispatch::runtime::RemoteAccess;
use std::path::PathBuf;

/// Access for workers on other machines; none by default.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct ListenChoice {
    /// Where workers of your own may connect: `quic/0.0.0.0:7447` from other machines, with certificates;
    /// `unix/PATH` on this machine, where PATH lies in a folder that only you can enter.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_LISTEN")]
    listen: Option<String>,
    /// Folder of certificates for `quic/` addresses, as `horsehead keys new` makes it.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    tls: Option<PathBuf>,
    /// Allow `tcp/` addresses, at which every user of every machine that reaches them can read jobs and forge
    /// results.
    #[arg(long, env = "HORSEHEAD_INSECURE")]
    insecure: bool,
}

impl ListenChoice {
    /// Returns whether the arguments let workers on other machines connect.
    pub(crate) const fn is_open(&self) -> bool {
        self.listen.is_some()
    }

    /// Returns the access that the arguments give.
    pub(crate) fn access(&self) -> RemoteAccess {
        RemoteAccess {
            listen: self.listen.clone(),
            tls: self.tls.clone(),
            insecure: self.insecure,
        }
    }
}
