//! The process of one slot, seen from its worker.
use super::CaseBytes;
use crate::stream;
use protocol::{
    id::ContentHash,
    job::Job,
    message::{FromSlot, ToSlot},
    wire::Kind,
};
use rustix::process::{Pid, Signal, kill_process_group};
use std::{
    io::{self, BufReader},
    os::unix::process::{CommandExt, ExitStatusExt},
    path::Path,
    process::{self, ChildStdin, Command, Stdio},
    thread,
};

/// A running slot process; ended with everything it started when dropped.
#[derive(Debug)]
pub(super) struct Child {
    process: process::Child,
    input: ChildStdin,
    case: Option<ContentHash>,
}

impl Child {
    /// Starts a process; `said` is called from a thread for each message and with `None` when its
    /// output ends.
    pub(super) fn start(
        program: &Path,
        said: impl Fn(Option<FromSlot>) + Send + 'static,
    ) -> io::Result<Self> {
        let mut process = Command::new(program)
            .arg("slot")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            // a group of its own: ended as a whole, and out of reach of Ctrl-C
            .process_group(0)
            .spawn()?;
        let closed = || io::Error::other("the pipes of the slot are closed");
        let input = process.stdin.take().ok_or_else(closed)?;
        let output = process.stdout.take().ok_or_else(closed)?;
        let child = Self {
            process,
            input,
            case: None,
        };
        thread::Builder::new()
            .name("slot-output".to_owned())
            .spawn(move || {
                let mut output = BufReader::new(output);
                while let Ok(Some(message)) = stream::read(&mut output, Kind::FromSlot) {
                    said(Some(message));
                }
                said(None);
            })?;
        Ok(child)
    }

    /// Hands over a job, and the case before it if it is another one.
    pub(super) fn run(&mut self, job: Box<Job>, case: Option<&CaseBytes>) -> io::Result<()> {
        if let Some(case) = case.filter(|case| self.case != Some(case.hash)) {
            let message = ToSlot::Case(case.bytes.to_vec());
            stream::write(&mut self.input, Kind::ToSlot, &message)?;
            self.case = Some(case.hash);
        }
        stream::write(&mut self.input, Kind::ToSlot, &ToSlot::Run(job))
    }

    /// Ends it and says how it ended.
    pub(super) fn end(mut self) -> String {
        self.kill();
        match self.process.wait() {
            Ok(status) => match (status.signal(), status.code()) {
                (Some(signal), _) => format!("ended by signal {signal}"),
                (None, Some(code)) => format!("ended with status {code}"),
                (None, None) => "ended without a status".to_owned(),
            },
            Err(error) => format!("its end is unknown: {error}"),
        }
    }

    /// Waits a moment for an end that is under way, then says how it was.
    pub(super) fn ended(mut self) -> String {
        for _ in 0..100 {
            match self.process.try_wait() {
                Ok(None) => thread::sleep(std::time::Duration::from_millis(10)),
                Ok(Some(_)) | Err(_) => break,
            }
        }
        self.end()
    }

    fn kill(&mut self) {
        let group = i32::try_from(self.process.id())
            .ok()
            .and_then(Pid::from_raw);
        if let Some(group) = group {
            // fails if the whole group has ended by itself
            drop(kill_process_group(group, Signal::KILL).map_err(io::Error::from));
        }
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        self.kill();
        drop(self.process.wait());
    }
}
