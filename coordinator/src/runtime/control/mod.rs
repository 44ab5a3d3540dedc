//! The socket of a running run: who works, and taking workers out of the work.
//!
//! It lies in the run folder, for the owner alone, and speaks lines of JSON: one question, one answer
//! ([`words`]). It knows no more of a run than its workers.
mod client;
mod server;
pub mod words;

pub use client::{ControlError, ask};
pub(super) use server::{Asked, Control};

use std::{fs::File, io, os::fd::AsRawFd, path::Path};

/// Name of the socket in the run folder.
pub const SOCKET: &str = "workers.sock";

/// A path of the socket that fits: those of sockets end after 107 bytes, so it goes through the folder,
/// which must stay open meanwhile.
fn through(folder: &Path) -> io::Result<(File, String)> {
    let folder = File::open(folder)?;
    let path = format!("/proc/self/fd/{}/{SOCKET}", folder.as_raw_fd());
    Ok((folder, path))
}
