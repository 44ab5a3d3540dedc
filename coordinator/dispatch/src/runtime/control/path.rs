//! Where the socket lies.
use std::{fs::File, io, os::fd::AsRawFd, path::Path};

/// Name of the socket in the run folder.
pub const SOCKET: &str = "workers.sock";

/// A path of the socket that fits: those of sockets end after 107 bytes, so it goes through the folder,
/// which must stay open meanwhile.
pub(super) fn through(folder: &Path) -> io::Result<(File, String)> {
    let folder = File::open(folder)?;
    let path = format!("/proc/self/fd/{}/{SOCKET}", folder.as_raw_fd());
    Ok((folder, path))
}
