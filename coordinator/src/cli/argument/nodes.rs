//! Arguments for hosts reached by ssh.
use clap::Args;
use launch::{Host, read_hosts};
use std::{fs, path::PathBuf};
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

/// Options of workers that are launched on other hosts.
#[derive(Clone, Debug, Args)]
pub(crate) struct LaunchChoice {
    /// Simulations at a time on each launched worker [default: one per hardware thread, or `cpu` of a pod].
    #[arg(long, value_name = "N", env = "HORSEHEAD_SLOTS", value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub(crate) slots: Option<u16>,
    /// Worker program for hosts of another kind, with ARCH as `uname -m` says; may be repeated.
    #[arg(
        long,
        value_name = "ARCH=PATH",
        env = "HORSEHEAD_WORKER_PROGRAM",
        value_delimiter = ','
    )]
    pub(crate) worker_program: Vec<String>,
    /// File of shell lines to run before a launched worker, as `module load gcc`.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_PROLOGUE")]
    prologue: Option<PathBuf>,
}

impl LaunchChoice {
    /// Reads the shell lines to run before a worker; empty if no file is named.
    pub(crate) fn prologue(&self) -> Result<String, Problem> {
        let Some(file) = &self.prologue else {
            return Ok(String::new());
        };
        fs::read_to_string(file).map_err(|error| Problem {
            message: format!("--prologue {}: {error}", file.display()),
            remedy: "name a file of shell lines".to_owned(),
        })
    }
}
