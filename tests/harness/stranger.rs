//! Commands run as another user of the machine, for tests of what strangers can reach.
use std::{ffi::OsStr, process::Command};

/// Returns a command that runs a program as the user `nobody`; notes a skipped check and returns `None` without the
/// right to change the user.
pub fn as_stranger(program: impl AsRef<OsStr>) -> Option<Command> {
    if !rustix::process::geteuid().is_root() {
        crate::skip("only root can act as another user");
        return None;
    }
    let mut command = Command::new("setpriv");
    command
        .args(["--reuid=65534", "--regid=65534", "--clear-groups", "--"])
        .arg(program);
    Some(command)
}
