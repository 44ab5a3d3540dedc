//! Helpers that locate, start, signal and stop real processes under test.
use dispatch::runtime::locate;
use rustix::process::{Pid, Signal, kill_process};
use std::{
    fs,
    net::{Ipv4Addr, TcpListener, UdpSocket},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::{
        OnceLock,
        atomic::{AtomicU32, Ordering},
    },
    thread,
    time::{Duration, Instant},
};

const FIRST_PORT: u32 = 20_000;
const PORTS: u32 = 12_000;

/// Returns the path of the worker program, which `cargo test --workspace` builds together with the
/// coordinator.
///
/// # Panics
/// If the program does not exist: `cargo build` makes it.
pub fn worker_program() -> PathBuf {
    locate::worker_program().expect("the worker program")
}

/// Returns the path of the coordinator program, in the same folder as the worker program.
///
/// # Panics
/// If the program does not exist: `cargo build` makes it.
pub fn coordinator_program() -> PathBuf {
    let program = worker_program().with_file_name("horsehead");
    let shown = program.display();
    assert!(program.is_file(), "`cargo build` makes {shown}");
    program
}

/// Returns the locator of a Unix socket in a new folder of the test process's own.
///
/// # Panics
/// If no folder can be made.
pub fn free_locator() -> String {
    static NUMBER: AtomicU32 = AtomicU32::new(0);
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| tempfile::tempdir().expect("a folder"));
    let number = NUMBER.fetch_add(1, Ordering::Relaxed);
    format!(
        "unix/{}",
        folder.path().join(format!("{number}/bus")).display()
    )
}

/// Returns a TCP locator with a free port on loopback.
///
/// # Panics
/// If the machine has no free port.
pub fn free_tcp_locator() -> String {
    free_port("tcp/127.0.0.1:0")
}

/// Returns a QUIC locator with a free port on loopback.
///
/// # Panics
/// If the machine has no free port.
pub fn free_quic_locator() -> String {
    free_port("quic/127.0.0.1:0")
}

/// Finds a free port below 32,768, where Linux does not allocate ports of outgoing connections, and replaces
/// the port of the locator `any`. Each port is handed out once in this process, so that no other test takes
/// it before the caller listens.
fn free_port(any: &str) -> String {
    static HANDED_OUT: AtomicU32 = AtomicU32::new(0);
    let mut any = link::locator::Locator::parse(any).expect("a locator");
    let first = std::process::id().wrapping_mul(97);
    (0..PORTS)
        .map(|_| first.wrapping_add(HANDED_OUT.fetch_add(1, Ordering::Relaxed)) % PORTS)
        .filter_map(|offset| u16::try_from(FIRST_PORT + offset).ok())
        .find(|port| {
            let at = (Ipv4Addr::LOCALHOST, *port);
            TcpListener::bind(at).is_ok() && UdpSocket::bind(at).is_ok()
        })
        .map(|port| {
            any.port = port;
            any.to_string()
        })
        .expect("a free port")
}

/// Child process that is killed when this handle is dropped.
#[derive(Debug)]
pub struct Process(Child);

impl Process {
    /// Starts a worker process.
    ///
    /// # Panics
    /// If it does not start.
    pub fn worker(connect: &str, arguments: &[&str]) -> Self {
        Self::worker_with(connect, arguments, &[])
    }

    /// Starts a worker process with additional environment variables.
    ///
    /// # Panics
    /// If it does not start.
    pub fn worker_with(connect: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut command = Command::new(worker_program());
        command.args(["--connect", connect]).args(arguments);
        command.envs(environment.iter().copied());
        Self::start(command)
    }

    /// Starts any program with its standard output piped.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start(mut command: Command) -> Self {
        let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
        Self(child.expect("the program starts"))
    }

    /// Starts any program with its standard error redirected to a file.
    ///
    /// # Panics
    /// If it does not start or the file cannot be made.
    pub fn logged(mut command: Command, log: &Path) -> Self {
        let log = fs::File::create(log).expect("a log file");
        command.stderr(log);
        Self::start(command)
    }

    /// Returns the id of the process.
    ///
    /// # Panics
    /// Never: ids are positive.
    pub fn pid(&self) -> Pid {
        i32::try_from(self.0.id())
            .ok()
            .and_then(Pid::from_raw)
            .expect("a process id")
    }

    /// Sends a signal to the process.
    ///
    /// # Panics
    /// If the process has been waited for.
    pub fn signal(&self, signal: Signal) {
        kill_process(self.pid(), signal).expect("the process is there");
    }

    /// Returns the standard output of the process.
    ///
    /// # Panics
    /// If called a second time.
    pub fn output(&mut self) -> std::process::ChildStdout {
        self.0.stdout.take().expect("the output is read once")
    }

    /// Returns the standard error of the process, if it was piped at the start.
    ///
    /// # Panics
    /// If called a second time, or if the standard error was not piped.
    pub fn errors(&mut self) -> std::process::ChildStderr {
        self.0.stderr.take().expect("the errors are read once")
    }

    /// Waits for the process to end and returns its exit code, or `None` if it was killed.
    ///
    /// # Panics
    /// If it does not end within `limit`.
    pub fn wait(&mut self, limit: Duration) -> Option<i32> {
        let mut status = None;
        wait_until("the process ends", limit, || {
            status = self.0.try_wait().expect("the process can be waited for");
            status.is_some()
        });
        status.and_then(|status| status.code())
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // fails only if it has ended by itself
        drop(self.0.kill());
        drop(self.0.wait());
    }
}

/// Returns the child processes of `parent`.
pub fn children(parent: Pid) -> Vec<Pid> {
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    processes
        .filter_map(|entry| {
            let pid = Pid::from_raw(entry.file_name().to_str()?.parse().ok()?)?;
            let stat = fs::read_to_string(entry.path().join("stat")).ok()?;
            // the name, in parentheses, may hold anything
            let (_, rest) = stat.rsplit_once(')')?;
            let of: i32 = rest.split_whitespace().nth(1)?.parse().ok()?;
            (of == parent.as_raw_nonzero().get()).then_some(pid)
        })
        .collect()
}

/// Returns the command line of a process; empty if the process has ended.
pub fn command_line(pid: Pid) -> Vec<String> {
    let words = fs::read_to_string(format!("/proc/{}/cmdline", pid.as_raw_nonzero()));
    let words = words.unwrap_or_default();
    words.split_terminator('\0').map(str::to_owned).collect()
}

/// Returns whether a process exists and is not a zombie.
pub fn is_alive(pid: Pid) -> bool {
    let stat = fs::read_to_string(format!("/proc/{}/stat", pid.as_raw_nonzero()));
    stat.is_ok_and(|stat| {
        let state = stat
            .rsplit_once(')')
            .and_then(|(_, rest)| rest.split_whitespace().next());
        state != Some("Z")
    })
}

/// Waits until a condition becomes true.
///
/// # Panics
/// If it does not become true within `limit`.
pub fn wait_until(what: &str, limit: Duration, mut is_true: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_true() {
        assert!(begun.elapsed() < limit, "not within {limit:?}: {what}");
        thread::sleep(Duration::from_millis(5));
    }
}
