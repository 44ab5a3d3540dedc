//! Process of one slot, as controlled by its worker.
use super::task::{CaseBytes, SlotOptions};
use crate::{external, process_tree, slot, stream};
use protocol::{
    id::ContentHash,
    job::Job,
    message::{FromSlot, ToSlot},
    wire::FrameKind,
};
use rustix::process::{Pid, Signal, kill_process, kill_process_group};
use std::{
    fs,
    io::{self, BufReader},
    os::unix::process::{CommandExt, ExitStatusExt},
    process::{self, ChildStdin, Command, ExitStatus, Stdio},
    sync::atomic::{AtomicU64, Ordering},
    thread,
    time::Duration,
};

/// Environment variable that marks a slot process and all processes started by it as belonging to the slot.
const MARK: &str = "HORSEHEAD_SLOT_PROCESS";

/// Counter of the slot processes started by this worker.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Processor time of a slot process since its start; all zero where the system does not report it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct ProcessorUsage {
    /// Time for which the slot process had a processor.
    pub(super) computed: Duration,
    /// Time for which the process was ready without a processor, excluding a wait that is still going on.
    pub(super) waited: Duration,
    /// Whether the process is computing or waiting for a processor now.
    pub(super) is_ready: bool,
}

/// Running slot process; on drop it is ended with all processes it started.
#[derive(Debug)]
pub(super) struct Child {
    process: process::Child,
    input: ChildStdin,
    case: Option<ContentHash>,
    /// Value of the environment variable that marks all processes started by this slot.
    mark: String,
    memory_mib: u64,
}

impl Child {
    /// Starts a process; `said` is called from a thread for each message, and with `None` when the process's
    /// output ends.
    pub(super) fn start(
        options: &SlotOptions,
        said: impl Fn(Option<FromSlot>) + Send + 'static,
    ) -> io::Result<Self> {
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let mark = format!("{}.{number}", process::id());
        let mut process = Command::new(&options.program)
            .arg("slot")
            .args(["--memory", &options.memory_mib.to_string()])
            .env(MARK, &mark)
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
            mark,
            memory_mib: options.memory_mib,
        };
        thread::Builder::new()
            .name("slot-output".to_owned())
            .spawn(move || {
                let mut output = BufReader::new(output);
                while let Ok(Some(message)) = stream::read(&mut output, FrameKind::FromSlot) {
                    said(Some(message));
                }
                said(None);
            })?;
        Ok(child)
    }

    /// Sends a job to the slot process, preceded by its case unless that was the last case sent.
    pub(super) fn run(&mut self, job: Box<Job>, case: Option<&CaseBytes>) -> io::Result<()> {
        if let Some(case) = case.filter(|case| self.case != Some(case.hash)) {
            let message = ToSlot::Case(case.bytes.to_vec());
            stream::write(&mut self.input, FrameKind::ToSlot, &message)?;
            self.case = Some(case.hash);
        }
        stream::write(&mut self.input, FrameKind::ToSlot, &ToSlot::Run(job))
    }

    /// Reads the processor time of the process's two threads that take turns: the one that reads jobs and the
    /// one that computes them. Other threads, which a job might start, do not count: many of them waiting at
    /// once would stop the deadline's clock.
    pub(super) fn processor_usage(&self) -> ProcessorUsage {
        let process = self.process.id().to_string();
        let threads = fs::read_dir(format!("/proc/{process}/task"));
        let mut look = ProcessorUsage::default();
        for thread in threads.into_iter().flatten().flatten() {
            let read = |name| fs::read_to_string(thread.path().join(name)).unwrap_or_default();
            let is_first = thread.file_name().to_str() == Some(&process);
            if !is_first && read("comm").trim_end() != slot::INPUT {
                continue;
            }
            let (times, state) = (read("schedstat"), read("stat"));
            let mut times = times.split_whitespace().map(|word| {
                let nanos = word.parse().unwrap_or(0);
                Duration::from_nanos(nanos)
            });
            look.computed += times.next().unwrap_or_default();
            look.waited += times.next().unwrap_or_default();
            // behind the name, which is in parentheses and may hold anything
            look.is_ready |= state
                .rsplit_once(')')
                .is_some_and(|(_, rest)| rest.trim_start().starts_with('R'));
        }
        look
    }

    /// Ends the slot process and describes how it ended.
    pub(super) fn end(mut self) -> String {
        self.kill();
        let ended = self.process.wait();
        external::remove_abandoned();
        match ended {
            Ok(status) => describe_status(status, self.memory_mib),
            Err(error) => format!("its exit status cannot be determined: {error}"),
        }
    }

    /// Waits up to a second for a process that is already ending, and describes its end.
    pub(super) fn ended(mut self) -> String {
        for _ in 0..100 {
            match self.process.try_wait() {
                Ok(None) => thread::sleep(Duration::from_millis(10)),
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
            // while its children are still known to be its own
            process_tree::end_with_all(group);
            // fails if the whole group has ended by itself
            drop(kill_process_group(group, Signal::KILL).map_err(io::Error::from));
        }
        end_marked(&self.mark);
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        self.kill();
        drop(self.process.wait());
        external::remove_abandoned();
    }
}

/// Describes how a process ended, with the likely cause.
fn describe_status(status: ExitStatus, memory_mib: u64) -> String {
    match (status.signal(), status.code()) {
        (Some(6), _) if memory_mib > 0 => format!(
            "was ended by signal 6: a bug, or more memory than the {memory_mib} MiB that a slot may \
             have (--slot-memory)"
        ),
        (Some(signal), _) => format!("was ended by signal {signal}"),
        (None, Some(code)) => format!("ended with status {code}"),
        (None, None) => "ended without a status".to_owned(),
    }
}

/// Ends every process with the slot's mark that left the slot's process group or outlived the process that
/// started it.
fn end_marked(mark: &str) {
    let entry = format!("{MARK}={mark}");
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    for process in processes {
        let name = process.file_name();
        let Some(pid) = name.to_str().and_then(|name| name.parse().ok()) else {
            continue;
        };
        // unreadable are those of other users, and those that have just ended
        let environment = fs::read(process.path().join("environ")).unwrap_or_default();
        let marked = environment
            .split(|byte| *byte == 0)
            .any(|variable| variable == entry.as_bytes());
        if let (true, Some(pid)) = (marked, Pid::from_raw(pid)) {
            // fails if it has just ended
            drop(kill_process(pid, Signal::KILL).map_err(io::Error::from));
        }
    }
}
