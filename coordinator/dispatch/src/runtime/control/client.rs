//! Client of a run's control socket.
use super::{
    messages::{ControlReply, ControlRequest},
    path::{SOCKET, short_path},
};
use crate::scheduler::WorkerReport;
use std::{
    io::{self, BufRead, BufReader, Read, Write},
    os::unix::net::UnixStream,
    path::{Path, PathBuf},
    time::Duration,
};

/// Time limit for the coordinator's answer to a control request.
const TIMEOUT: Duration = Duration::from_secs(5);
/// Maximum length of the coordinator's answer (bytes), enough for thousands of workers.
const LONGEST: u64 = 64 << 20;

/// Reason why a run does not answer a control request.
#[derive(Debug, thiserror::Error)]
pub enum ControlError {
    /// No coordinator process works on the run.
    #[error("no `horsehead` process is working on the run {}: {reason}", folder.display())]
    NotRunning {
        /// Folder of the run.
        folder: PathBuf,
        /// Error of the operating system when connecting to the control socket.
        reason: io::Error,
    },
    /// The coordinator does not understand the request, or has no worker of that name.
    #[error("{}: {reason}", folder.display())]
    Refused {
        /// Folder of the run whose coordinator refused the request.
        folder: PathBuf,
        /// Reason given by the coordinator.
        reason: String,
    },
}

/// Sends a request to the coordinator process of a run folder; returns the workers concerned.
///
/// # Errors
/// [`ControlError`] if no process works on the run, or it refuses the request.
pub fn send_request(
    folder: &Path,
    question: &ControlRequest,
) -> Result<Vec<WorkerReport>, ControlError> {
    let reply = exchange(folder, question).map_err(|reason| ControlError::NotRunning {
        folder: folder.to_owned(),
        reason,
    })?;
    match reply {
        ControlReply::Workers(workers) => Ok(workers),
        ControlReply::Error(reason) => Err(ControlError::Refused {
            folder: folder.to_owned(),
            reason,
        }),
    }
}

fn exchange(folder: &Path, question: &ControlRequest) -> io::Result<ControlReply> {
    let (_open, path) = short_path(folder)?;
    let mut stream = UnixStream::connect(path)
        .map_err(|error| io::Error::new(error.kind(), format!("{SOCKET}: {error}")))?;
    stream.set_read_timeout(Some(TIMEOUT))?;
    stream.set_write_timeout(Some(TIMEOUT))?;
    let mut line = serde_json::to_vec(question)?;
    line.push(b'\n');
    stream.write_all(&line)?;
    let mut answer = String::new();
    BufReader::new(stream.take(LONGEST)).read_line(&mut answer)?;
    Ok(serde_json::from_str(&answer)?)
}
