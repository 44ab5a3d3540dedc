//! Dashboard of a run that a command begins with `--dashboard`: a process of its own, so that neither its work nor
//! its readers hold up the run.
use crate::message;
use std::{
    io::{self, BufRead as _, BufReader},
    os::unix::process::CommandExt as _,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

/// Longest wait for the dashboard to end after the run; it shows the end of the run before it goes.
const PATIENCE: Duration = Duration::from_secs(8);

/// Dashboard process of a run; ends soon after this value is dropped.
pub(super) struct AttachedDashboard(Child);

impl AttachedDashboard {
    /// Starts the dashboard of a run and prints its address; a dashboard that cannot be started is only noted.
    pub(super) fn start(run: &Path, port: u16) -> Option<Self> {
        match Self::try_start(run, port) {
            Ok((own, url)) => {
                message::print(&format!("dashboard: {url}"));
                Some(own)
            }
            Err(error) => {
                message::print(&format!(
                    "warning: the dashboard cannot be started: {error}; the run goes on without it"
                ));
                None
            }
        }
    }

    fn try_start(run: &Path, port: u16) -> io::Result<(Self, String)> {
        let mut child = Command::new(std::env::current_exe()?)
            .arg("dashboard")
            .arg(run)
            .args(["--attached", "--port", &port.to_string()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            // Ctrl-C is for the run: the page shows how it stops
            .process_group(0)
            .spawn()?;
        let mut url = String::new();
        if let Some(output) = child.stdout.take() {
            BufReader::new(output).read_line(&mut url)?;
        }
        let url = url.trim().to_owned();
        if url.is_empty() {
            child.wait()?;
            return Err(io::Error::other(format!("no port from {port} on is free")));
        }
        Ok((Self(child), url))
    }
}

impl Drop for AttachedDashboard {
    fn drop(&mut self) {
        // the end of its input tells it that the run is over
        drop(self.0.stdin.take());
        let begun = Instant::now();
        while begun.elapsed() < PATIENCE {
            if !matches!(self.0.try_wait(), Ok(None)) {
                return;
            }
            thread::sleep(Duration::from_millis(50));
        }
        let _ended = self.0.kill().and_then(|()| self.0.wait());
    }
}
