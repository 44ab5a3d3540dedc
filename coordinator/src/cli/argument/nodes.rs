//! Arguments for hosts reached by ssh.
use clap::Args;
use launch::{Host, read_hosts};
use std::path::PathBuf;
use support::Problem;

/// Hosts, one by one or from a file.
#[derive(Clone, Debug, Args)]
pub(crate) struct HostsChoice {
    /// Hosts that your ssh reaches, as HOST or USER@HOST:PORT.
    #[arg(
        long,
        value_name = "HOSTS",
        env = "HORSEHEAD_SSH",
        value_delimiter = ','
    )]
    ssh: Vec<String>,
    /// File of hosts, one a line, with `slots=N` after those that differ.
    #[arg(
        long,
        value_name = "FILE",
        env = "HORSEHEAD_HOSTS",
        conflicts_with = "ssh"
    )]
    hosts: Option<PathBuf>,
}

impl HostsChoice {
    pub(crate) const fn is_empty(&self) -> bool {
        self.ssh.is_empty() && self.hosts.is_none()
    }

    /// Reads the list of ssh hosts from the arguments or from the hosts file.
    pub(crate) fn read(&self) -> Result<Vec<Host>, Problem> {
        match &self.hosts {
            Some(file) => read_hosts(file),
            None => self.ssh.iter().map(|host| host.parse()).collect(),
        }
    }
}
