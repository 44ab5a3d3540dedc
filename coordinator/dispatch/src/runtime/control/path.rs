//! Path of the control socket.
use std::{fs::File, io, os::fd::AsRawFd, path::Path};

/// Name of the control socket in the run folder.
pub const SOCKET: &str = "workers.sock";

/// Returns a short path to the control socket, through the descriptor of the run folder, which must stay open
/// while the path is used: socket paths are limited to 107 bytes.
pub(super) fn short_path(folder: &Path) -> io::Result<(File, String)> {
    let folder = File::open(folder)?;
    let path = format!("/proc/self/fd/{}/{SOCKET}", folder.as_raw_fd());
    Ok((folder, path))
}
