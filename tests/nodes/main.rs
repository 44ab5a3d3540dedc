//! Tests of workers on other hosts: launched, listed, drained, expelled and stopped, with real processes.
//!
//! A script replaces `ssh`: it runs the given command on this machine with a separate home folder for each
//! host. Command line, copying, keys, worker and QUIC are real.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod ended;
mod machines;
mod plans;
mod refusals;
mod resumed;
mod run;
mod spare;

use serde_json::Value;
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tests::process::{coordinator_program, free_quic_locator};

/// Shell script that replaces ssh. Depending on the host name, it fails with a message of the real ssh, or
/// simulates an old C library, another processor, a full disk or
/// a shell that hangs when workers are to be ended.
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
hanging)
  if [ "$2" = 'sh -s' ]; then
    script=$(cat)
    case "$script" in *'for folder in'*) exec sleep 600 ;; esac
    printf '%s\n' "$script" | HOME=$home sh -s
    exit
  fi
  ;;
full)
  HOME=$home exec unshare -m sh -c 'mount -t tmpfs -o size=1m none "$HOME" && exec sh -c "$1"' sh "$2"
  ;;
esac
HOME=$home exec sh -c "$2"
"#;

/// Test folder with key material, home folders of hosts, and a script that replaces ssh.
struct Site {
    folder: tempfile::TempDir,
    locator: String,
}

impl Site {
    fn new(workers: u32) -> Self {
        Self::with_host(workers, "127.0.0.1")
    }

    /// Creates a test folder with a coordinator certificate that is valid for the given host.
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

    /// Returns a command that runs the coordinator with these arguments.
    fn command(&self, words: &[&str]) -> Command {
        let mut command = self.program(coordinator_program());
        command.args(words);
        command
    }

    /// Returns a command that runs a program with the ssh replacement first in `PATH`.
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

    /// Runs `workers up` with the coordinator address and keys of this test folder.
    fn up(&self, words: &[&str]) -> Output {
        let common = ["workers", "up", "--connect", &self.locator, "--tls", "keys"];
        self.horsehead(&[&common, words].concat())
    }

    /// Returns the workers listed by `workers list` in its JSON output.
    fn list(&self) -> Vec<Value> {
        let listed = self.horsehead(&["workers", "list", "--run", "run", "--output", "json"]);
        assert!(listed.status.success(), "{}", errors(&listed));
        let object: Value = serde_json::from_slice(&listed.stdout).unwrap();
        object["workers"].as_array().unwrap().clone()
    }

    /// Returns the folder in which a worker on a host keeps its files.
    fn at(&self, host: &str, name: &str) -> PathBuf {
        let entries = fs::read_dir(self.path(&format!("homes/{host}/.cache/horsehead")));
        let mut folders = entries.unwrap().flatten().map(|entry| entry.path());
        let is = |path: &PathBuf| {
            let file = path.file_name().and_then(|name| name.to_str());
            path.is_dir() && file.is_some_and(|file| file.starts_with(name))
        };
        folders.find(is).unwrap()
    }

    /// Returns the process id of a worker on a host.
    fn process(&self, host: &str, name: &str) -> String {
        fs::read_to_string(self.at(host, name).join("process"))
            .unwrap()
            .trim()
            .to_owned()
    }
}

/// Stops all workers that the test started.
impl Drop for Site {
    fn drop(&mut self) {
        let hosts = fs::read_dir(self.path("homes")).into_iter().flatten();
        for host in hosts.flatten() {
            let host = host.file_name().into_string().unwrap();
            if host.len() == 1 {
                drop(self.horsehead(&["workers", "down", "--all", "--ssh", &host]));
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
