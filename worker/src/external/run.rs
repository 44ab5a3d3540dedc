//! Runs an external program once: starts it within its limits, monitors it, and ends it with all processes it
//! started.
use super::{own_folder, scratch_folder::ScratchFolder};
use crate::process_tree;
use exchange::allow::AllowEntry;
use protocol::job::{Failure, LAST_OUTPUT, NO_OUTPUT};
use rustix::process::{WaitOptions, getpid, set_child_subreaper, wait};
use std::{
    env,
    fs::{self, File},
    io::{self, Read, Seek, SeekFrom},
    os::unix::process::{CommandExt, ExitStatusExt},
    path::Path,
    process::{Child, Command, ExitStatus, Stdio},
    sync::mpsc::{self, RecvTimeoutError},
    thread,
    time::{Duration, Instant},
};

/// Interval at which the amount of output that a running program has written is checked.
const POLL_INTERVAL: Duration = Duration::from_millis(500);
/// Number of bytes shown from the end of a program's output; `LINES` is the largest number of lines shown.
const LAST: u64 = 2000;
const LINES: usize = 8;
/// Environment variables of this process that are passed to every program.
const INHERITED_VARIABLES: [&str; 6] = ["PATH", "HOME", "LANG", "LC_ALL", "TZ", "TMPDIR"];

/// Starts the program of an entry of the list of allowed programs in a folder and waits for it to end, at
/// most until the deadline.
///
/// # Errors
/// [`Failure::Crashed`] if the program cannot be started or writes too much, [`Failure::Deadline`] if it does
/// not end in time.
pub(super) fn run(
    entry: &AllowEntry,
    scratch: &ScratchFolder,
    deadline: Duration,
) -> Result<ExitStatus, Failure> {
    let crashed = Failure::crashed;
    let failed = |what: &str, error: &io::Error| crashed(format!("{what}: {error}"));
    // whatever the program leaves without a parent becomes ours, and is ended
    set_child_subreaper(Some(getpid())).map_err(|error| failed("subreaper", &error.into()))?;
    let began = Instant::now();
    let mut child = begin(entry, scratch).map_err(|error| {
        failed(
            &format!("{} cannot be started", entry.program.display()),
            &error,
        )
    })?;
    let ended = watch(&mut child, entry, scratch, began + deadline);
    process_tree::end_below(getpid());
    while let Ok(Some(_)) = wait(WaitOptions::NOHANG) {}
    match ended {
        Ok(status) => Ok(status),
        Err(Stopped::Deadline) => Err(Failure::deadline(
            u64::try_from(deadline.as_millis()).unwrap_or(u64::MAX),
        )),
        Err(Stopped::OutputLimit) => Err(crashed(format!(
            "it wrote more than the {} MiB that its entry allows (output_mib){}",
            entry.output_mib,
            output_tail(scratch)
        ))),
        Err(Stopped::Unknown(error)) => Err(failed("its exit status cannot be determined", &error)),
    }
}

/// Reason why a program is ended before it finishes.
enum Stopped {
    Deadline,
    OutputLimit,
    Unknown(io::Error),
}

fn begin(entry: &AllowEntry, scratch: &ScratchFolder) -> io::Result<Child> {
    let said = File::create(scratch.output_path())?;
    let mut command = Command::new(env::current_exe()?);
    command
        .arg("start")
        .args(["--memory", &entry.memory_mib.to_string()])
        .args(["--file", &entry.output_mib.to_string()])
        .arg("--")
        .arg(&entry.program)
        .args(&entry.arguments)
        .current_dir(scratch.work())
        .stdin(Stdio::null())
        .stderr(said.try_clone()?)
        .stdout(said)
        // a group of its own: a signal that it sends to its group does not reach us
        .process_group(0)
        .env_clear();
    for name in INHERITED_VARIABLES
        .into_iter()
        .chain(entry.pass.iter().map(String::as_str))
    {
        if let Some(value) = env::var_os(name) {
            command.env(name, value);
        }
    }
    command.envs(&entry.environment).spawn()
}

/// Waits for the process to end, in a separate thread so that the end need not be polled for.
fn watch(
    child: &mut Child,
    entry: &AllowEntry,
    scratch: &ScratchFolder,
    until: Instant,
) -> Result<ExitStatus, Stopped> {
    let (over, ended) = mpsc::channel();
    let most = entry.output_mib.saturating_mul(1 << 20);
    thread::scope(|scope| {
        let waiting = scope.spawn(move || {
            let status = child.wait();
            // whoever watched may have gone
            let _unheard = over.send(());
            status
        });
        let stopped = loop {
            let left = until.saturating_duration_since(Instant::now());
            match ended.recv_timeout(left.min(POLL_INTERVAL)) {
                Ok(()) | Err(RecvTimeoutError::Disconnected) => break None,
                Err(RecvTimeoutError::Timeout) if left.is_zero() => break Some(Stopped::Deadline),
                Err(RecvTimeoutError::Timeout) if most > 0 && scratch.bytes() > most => {
                    break Some(Stopped::OutputLimit);
                }
                Err(RecvTimeoutError::Timeout) => {}
            }
        };
        if stopped.is_some() {
            process_tree::end_below(getpid());
        }
        let status = waiting.join();
        match (stopped, status) {
            (Some(stopped), _) => Err(stopped),
            (None, Ok(Ok(status))) => Ok(status),
            (None, Ok(Err(error))) => Err(Stopped::Unknown(error)),
            (None, Err(_)) => Err(Stopped::Unknown(io::Error::other(
                "the thread waiting for the program stopped unexpectedly",
            ))),
        }
    })
}

/// Describes a program's exit status, with the last lines of its output.
pub(super) fn describe_status(status: ExitStatus, scratch: &ScratchFolder) -> String {
    // a shell says the signal that ended what it had started
    let of_child = status.code().filter(|code| (129..160).contains(code));
    let signal = status.signal().or(of_child.map(|code| code - 128));
    let how = match (signal, status.code()) {
        (Some(25), _) => {
            "was ended: it wrote a file longer than its entry allows (output_mib)".to_owned()
        }
        (Some(signal), _) => format!("was ended by signal {signal}"),
        (None, Some(127)) => "could not be started, or ended with status 127".to_owned(),
        (None, Some(code)) => format!("ended with status {code}"),
        (None, None) => "ended without a status".to_owned(),
    };
    how + &output_tail(scratch)
}

/// Formats the last lines of a program's output as the end of a message.
pub(super) fn output_tail(scratch: &ScratchFolder) -> String {
    let text = tail(&scratch.output_path()).unwrap_or_default();
    // the folder is another one in every run, and names the files in it
    let folder = format!("{}/", scratch.work().display());
    let text: String = text
        .replace(&folder, "")
        .chars()
        .filter(|letter| !letter.is_control() || *letter == '\n')
        .collect();
    let lines: Vec<&str> = text
        .lines()
        .filter(|line| !line.trim().is_empty())
        .collect();
    let last = lines
        .get(lines.len().saturating_sub(LINES)..)
        .unwrap_or_default();
    if last.is_empty() {
        NO_OUTPUT.to_owned()
    } else {
        format!("{LAST_OUTPUT}\n  {}", last.join("\n  "))
    }
}

fn tail(path: &Path) -> io::Result<String> {
    let mut file = File::open(path)?;
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(LAST)))?;
    let mut bytes = Vec::new();
    file.take(LAST).read_to_end(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// Reads an output file of the program as text.
///
/// # Errors
/// A message if the file is missing, is not a regular file, or is longer than the program's entry allows.
pub(super) fn read_output(
    scratch: &ScratchFolder,
    file: &str,
    entry: &AllowEntry,
) -> Result<String, String> {
    let path = scratch.inside(file).map_err(|error| error.to_string())?;
    let found = fs::symlink_metadata(&path).map_err(|_| format!("it wrote no file `{file}`"))?;
    if !found.is_file() {
        return Err(format!("`{file}` is not a regular file"));
    }
    let most = entry.output_mib.saturating_mul(1 << 20);
    if most > 0 && found.len() > most {
        return Err(format!(
            "`{file}` has {} bytes, allowed are {most} (output_mib)",
            found.len()
        ));
    }
    let bytes = fs::read(&path).map_err(|error| format!("`{file}`: {error}"))?;
    Ok(exchange::decoded(&bytes).into_owned())
}

/// Permission to run one of the limited number of simultaneous processes of a program on this computer, held
/// as a file lock until dropped.
pub(super) struct RunPermit {
    _lock: File,
}

impl RunPermit {
    /// Waits until another process of the program may run; returns `None` if its entry sets no limit.
    pub(super) fn acquire(
        parent: &Path,
        name: &str,
        entry: &AllowEntry,
    ) -> io::Result<Option<Self>> {
        /// Interval at which the locks of the simultaneous processes are tried again.
        const PAUSE: Duration = Duration::from_millis(10);
        let Some(places) = entry.max_concurrent() else {
            return Ok(None);
        };
        // locks are those of this user's processes: a stranger's cannot hold them up
        let place = own_folder::below(parent)?;
        loop {
            for number in 0..places {
                let path = place.join(format!("{name}.{number}.lock"));
                let mut options = fs::OpenOptions::new();
                let file = options.create(true).append(true).open(path)?;
                if file.try_lock().is_ok() {
                    return Ok(Some(Self { _lock: file }));
                }
            }
            thread::sleep(PAUSE);
        }
    }
}
