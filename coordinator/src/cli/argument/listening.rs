//! Arguments that let workers on other machines connect.
use clap::Args;
use dispatch::runtime::DispatchOptions;
use std::path::PathBuf;

/// Access for workers on other machines; none by default.
#[derive(Clone, Debug, Default, Args)]
pub(crate) struct RemoteAccess {
    /// Where workers of your own may connect: `quic/0.0.0.0:7447` from other machines, with certificates;
    /// `unix/PATH` on this machine, where PATH lies in a folder that only you can enter.
    #[arg(long, value_name = "LOCATOR", env = "HORSEHEAD_LISTEN")]
    pub(crate) listen: Option<String>,
    /// Folder of certificates for `quic/` addresses, as `horsehead keys new` makes it.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_TLS")]
    pub(crate) tls: Option<PathBuf>,
    /// Allow `tcp/` addresses, at which every user of every machine that reaches them can read jobs and forge
    /// results.
    #[arg(long, env = "HORSEHEAD_INSECURE")]
    pub(crate) insecure: bool,
}

impl RemoteAccess {
    /// Lets workers on other machines join a run.
    pub(crate) fn allow(self, options: &mut DispatchOptions) {
        options.listen = self.listen;
        options.tls = self.tls;
        options.insecure = self.insecure;
    }
}
