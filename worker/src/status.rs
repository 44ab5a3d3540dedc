//! Status of a worker in a file, for the program that started it: `horsehead workers up` reads it on each host.
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};

/// Status of a worker towards its coordinator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status<'a> {
    /// The coordinator has not been reached yet, or not yet admitted the worker; with what is in the way, if
    /// anything is.
    Connecting(&'a str),
    /// The coordinator has admitted the worker to its run.
    Admitted,
    /// The worker has ended, with the reason.
    Ended(&'a str),
}

impl std::fmt::Display for Status<'_> {
    fn fmt(&self, to: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Connecting("") => write!(to, "connecting"),
            Self::Connecting(obstacle) => write!(to, "connecting: {obstacle}"),
            Self::Admitted => write!(to, "admitted"),
            Self::Ended(reason) => write!(to, "ended: {reason}"),
        }
    }
}

/// File that holds the status of a worker as one line; no file if there is no path.
#[derive(Debug, Default)]
pub struct StatusFile {
    path: Option<PathBuf>,
    failed: AtomicBool,
}

impl StatusFile {
    /// Creates the status of a worker that is written to `path`, if one is given.
    pub const fn new(path: Option<PathBuf>) -> Self {
        Self {
            path,
            failed: AtomicBool::new(false),
        }
    }

    /// Replaces the content of the file: a reader sees either the status before or this one. A file that
    /// cannot be written is logged once and does not keep the worker from its work.
    pub fn set(&self, status: Status<'_>) {
        let Some(path) = &self.path else { return };
        let line: String = status.to_string().lines().collect::<Vec<_>>().join(" ");
        let part = path.with_extension("part");
        let written = fs::write(&part, line + "\n").and_then(|()| fs::rename(&part, path));
        if let Err(error) = written
            && !self.failed.swap(true, Ordering::Relaxed)
        {
            tracing::warn!("{}: the status cannot be written: {error}", path.display());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn status_is_one_line_and_the_latest() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("status");
        let file = StatusFile::new(Some(path.clone()));
        for (status, line) in [
            (Status::Connecting(""), "connecting\n"),
            (
                Status::Connecting("nobody\nanswers"),
                "connecting: nobody answers\n",
            ),
            (Status::Admitted, "admitted\n"),
            (Status::Ended("refused"), "ended: refused\n"),
        ] {
            file.set(status);
            assert_eq!(fs::read_to_string(&path).unwrap(), line);
        }
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_does_not_exist_stops_nothing() {
        let file = StatusFile::new(Some(PathBuf::from("/nonexistent/status")));
        file.set(Status::Admitted);
        assert!(file.failed.load(Ordering::Relaxed));
        StatusFile::default().set(Status::Admitted);
    }
}
