//! Workers on other nodes: brought up, listed, drained, thrown out and ended, with real processes.
//!
//! A program stands for `ssh`: it runs what it is given in a home of the host's own, on this machine. All
//! else is real: the command line, the copy, the keys, the worker, QUIC.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod machines;
mod plans;
mod refusals;
mod resumed;
mod run;

use serde_json::Value;
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tests::process::{coordinator_program, free_quic_locator};

/// What stands for ssh. By name some hosts refuse as the real one does, have an old C library or a
/// full disk.
const SSH: &str = r#"#!/bin/sh
while :; do
  case "$1" in
  -o | -p) shift 2 ;;
  *) break ;;
  esac
done
home=$HOMES/$1
mkdir -p "$home"
case "$1" in
unknown) echo 'Host key verification failed.' >&2; exit 255 ;;
changed)
  echo '@    WARNING: REMOTE HOST IDENTIFICATION HAS CHANGED!     @' >&2
  echo 'Host key verification failed.' >&2
  exit 255
  ;;
locked) echo 'me@locked: Permission denied (publickey,password).' >&2; exit 255 ;;
nowhere) echo 'ssh: Could not resolve hostname nowhere: Name or service not known' >&2; exit 255 ;;
old)
  printf '#!/bin/sh\necho glibc 2.17\n' > "$home/getconf"
  chmod +x "$home/getconf"
  PATH=$home:$PATH
  ;;
other)
  printf '#!/bin/sh\necho Linux mips\n' > "$home/uname"
  chmod +x "$home/uname"
  PATH=$home:$PATH
  ;;
full)
  HOME=$home exec unshare -m sh -c 'mount -t tmpfs -o size=1m none "$HOME" && exec sh -c "$1"' sh "$2"
  ;;
esac
HOME=$home exec sh -c "$2"
"#;

/// Key material, homes of hosts, and a program that stands for ssh.
struct Site {
    folder: tempfile::TempDir,
    locator: String,
}

impl Site {
    fn new(workers: u32) -> Self {
        Self::with_host(workers, "127.0.0.1")
    }

    /// The same for a coordinator that workers dial at another address.
    fn with_host(workers: u32, host: &str) -> Self {
        let site = Self {
            folder: tempfile::tempdir().unwrap(),
            locator: free_quic_locator(),
        };
        let ssh = site.path("bin/ssh");
        fs::create_dir_all(site.path("bin")).unwrap();
        fs::write(&ssh, SSH).unwrap();
        fs::set_permissions(&ssh, fs::Permissions::from_mode(0o755)).unwrap();
        let keys = site.path("keys");
        let made = site.horsehead(&[
            "keys",
            "new",
            keys.to_str().unwrap(),
            "--host",
            host,
            "--workers",
            &workers.to_string(),
        ]);
        assert!(made.status.success(), "{}", errors(&made));
        site
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// The program of the coordinator.
    fn command(&self, words: &[&str]) -> Command {
        let mut command = self.program(coordinator_program());
        command.args(words);
        command
    }

    /// A program, with what stands for ssh before the real one.
    fn program(&self, program: impl AsRef<std::ffi::OsStr>) -> Command {
        let mut command = Command::new(program);
        let path = std::env::var("PATH").unwrap();
        command
            .current_dir(self.folder.path())
            .env("PATH", format!("{}:{path}", self.path("bin").display()))
            .env("HOMES", self.path("homes"))
            .env_remove("XDG_CACHE_HOME");
        command
    }

    fn horsehead(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    /// `workers up` with this site's coordinator and keys.
    fn up(&self, words: &[&str]) -> Output {
        let common = ["workers", "up", "--connect", &self.locator, "--tls", "keys"];
        self.horsehead(&[&common, words].concat())
    }

    /// What `workers list` says of everybody.
    fn list(&self) -> Vec<Value> {
        let listed = self.horsehead(&["workers", "list", "--run", "run", "--output", "json"]);
        assert!(listed.status.success(), "{}", errors(&listed));
        let object: Value = serde_json::from_slice(&listed.stdout).unwrap();
        object["workers"].as_array().unwrap().clone()
    }

    /// The folder of a worker on a host.
    fn at(&self, host: &str, name: &str) -> PathBuf {
        let entries = fs::read_dir(self.path(&format!("homes/{host}/.cache/horsehead")));
        let mut folders = entries.unwrap().flatten().map(|entry| entry.path());
        let is = |path: &PathBuf| {
            let file = path.file_name().and_then(|name| name.to_str());
            path.is_dir() && file.is_some_and(|file| file.starts_with(name))
        };
        folders.find(is).unwrap()
    }

    /// Number of a worker's process on a host.
    fn process(&self, host: &str, name: &str) -> String {
        fs::read_to_string(self.at(host, name).join("process"))
            .unwrap()
            .trim()
            .to_owned()
    }
}

/// Nothing that was started may outlive a test.
impl Drop for Site {
    fn drop(&mut self) {
        let hosts = fs::read_dir(self.path("homes")).into_iter().flatten();
        for host in hosts.flatten() {
            let host = host.file_name().into_string().unwrap();
            if host.len() == 1 {
                drop(self.horsehead(&["workers", "down", "--ssh", &host]));
            }
        }
    }
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn runs(process: &str) -> bool {
    Path::new("/proc")
        .join(process)
        .join("exe")
        .read_link()
        .is_ok()
}
