//! Asking a running run.
use super::{
    path::{SOCKET, through},
    words::{Question, Reply, Worker},
};
use std::{
    io::{self, BufRead, BufReader, Read, Write},
    os::unix::net::UnixStream,
    path::{Path, PathBuf},
    time::Duration,
};

/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest answer (bytes): thousands of workers.
const LONGEST: u64 = 64 << 20;

/// Why a run does not answer.
#[derive(Debug, thiserror::Error)]
pub enum ControlError {
    /// No process works on it.
    #[error("nobody works on {} now: {reason}", folder.display())]
    Nobody {
        /// The run folder.
        folder: PathBuf,
        /// The system's words.
        reason: io::Error,
    },
    /// It does not understand, or has no such worker.
    #[error("{}: {reason}", folder.display())]
    Refused {
        /// The run folder.
        folder: PathBuf,
        /// Its words.
        reason: String,
    },
}

/// Asks the process that works on the run of a folder; the workers that the answer is about.
///
/// # Errors
/// [`ControlError`] if there is none, or it refuses.
pub fn ask(folder: &Path, question: &Question) -> Result<Vec<Worker>, ControlError> {
    let reply = exchange(folder, question).map_err(|reason| ControlError::Nobody {
        folder: folder.to_owned(),
        reason,
    })?;
    match reply {
        Reply::Workers(workers) => Ok(workers),
        Reply::Error(reason) => Err(ControlError::Refused {
            folder: folder.to_owned(),
            reason,
        }),
    }
}

fn exchange(folder: &Path, question: &Question) -> io::Result<Reply> {
    let (_open, path) = through(folder)?;
    let mut stream = UnixStream::connect(path)
        .map_err(|error| io::Error::new(error.kind(), format!("{SOCKET}: {error}")))?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(PATIENCE))?;
    let mut line = serde_json::to_vec(question)?;
    line.push(b'\n');
    stream.write_all(&line)?;
    let mut answer = String::new();
    BufReader::new(stream.take(LONGEST)).read_line(&mut answer)?;
    Ok(serde_json::from_str(&answer)?)
}
