//! Real processes under test: found, started, disturbed, and gone at the end.
use dispatch::runtime::locate;
use rustix::process::{Pid, Signal, kill_process};
use std::{
    fs,
    net::{Ipv4Addr, TcpListener, UdpSocket},
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    sync::atomic::{AtomicU32, Ordering},
    thread,
    time::{Duration, Instant},
};

const FIRST_PORT: u32 = 20_000;
const PORTS: u32 = 12_000;

/// The worker program: `cargo test --workspace` puts it, and the coordinator's, where the suites look.
///
/// # Panics
/// If it is not there: `cargo build` makes it.
pub fn worker_program() -> PathBuf {
    locate::worker_program().expect("the worker program")
}

/// The coordinator program, beside the worker's.
///
/// # Panics
/// If it is not there: `cargo build` makes it.
pub fn coordinator_program() -> PathBuf {
    let program = worker_program().with_file_name("horsehead");
    let shown = program.display();
    assert!(program.is_file(), "`cargo build` makes {shown}");
    program
}

/// A free port on loopback, as a locator.
///
/// # Panics
/// If the machine has none.
pub fn free_locator() -> String {
    free_port("tcp/127.0.0.1:0")
}

/// The same for QUIC.
///
/// # Panics
/// If the machine has none.
pub fn free_quic_locator() -> String {
    free_port("quic/127.0.0.1:0")
}

/// Ports that no outgoing connection is given (Linux takes those from 32,768 on), each handed out once
/// in this process: nobody takes one between here and the one who listens.
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

/// A process that is killed when dropped.
#[derive(Debug)]
pub struct Process(Child);

impl Process {
    /// Starts a worker.
    ///
    /// # Panics
    /// If it does not start.
    pub fn worker(connect: &str, arguments: &[&str]) -> Self {
        Self::worker_with(connect, arguments, &[])
    }

    /// Starts a worker with something in its environment.
    ///
    /// # Panics
    /// If it does not start.
    pub fn worker_with(connect: &str, arguments: &[&str], environment: &[(&str, &str)]) -> Self {
        let mut command = Command::new(worker_program());
        command.args(["--connect", connect]).args(arguments);
        command.envs(environment.iter().copied());
        Self::start(command)
    }

    /// Starts any program, with its standard output to be read.
    ///
    /// # Panics
    /// If it does not start.
    pub fn start(mut command: Command) -> Self {
        let child = command.stdin(Stdio::null()).stdout(Stdio::piped()).spawn();
        Self(child.expect("the program starts"))
    }

    /// Starts any program that writes what it has to say into a file.
    ///
    /// # Panics
    /// If it does not start or the file cannot be made.
    pub fn logged(mut command: Command, log: &Path) -> Self {
        let log = fs::File::create(log).expect("a log file");
        command.stderr(log);
        Self::start(command)
    }

    /// Its process id.
    ///
    /// # Panics
    /// Never: ids are positive.
    pub fn pid(&self) -> Pid {
        i32::try_from(self.0.id())
            .ok()
            .and_then(Pid::from_raw)
            .expect("a process id")
    }

    /// Sends a signal.
    ///
    /// # Panics
    /// If the process has been waited for.
    pub fn signal(&self, signal: Signal) {
        kill_process(self.pid(), signal).expect("the process is there");
    }

    /// Its standard output.
    ///
    /// # Panics
    /// The second time.
    pub fn output(&mut self) -> std::process::ChildStdout {
        self.0.stdout.take().expect("the output is read once")
    }

    /// Its standard error, if it was asked for when the process was started.
    ///
    /// # Panics
    /// The second time, and if it was not.
    pub fn errors(&mut self) -> std::process::ChildStderr {
        self.0.stderr.take().expect("the errors are read once")
    }

    /// Waits for its end and returns its exit code, if it was not killed.
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

/// Processes whose parent is `parent`.
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

/// The words a process was started with; none if it has ended.
pub fn command_line(pid: Pid) -> Vec<String> {
    let words = fs::read_to_string(format!("/proc/{}/cmdline", pid.as_raw_nonzero()));
    let words = words.unwrap_or_default();
    words.split_terminator('\0').map(str::to_owned).collect()
}

/// Whether a process is there and not just waiting to be reaped.
pub fn is_alive(pid: Pid) -> bool {
    let stat = fs::read_to_string(format!("/proc/{}/stat", pid.as_raw_nonzero()));
    stat.is_ok_and(|stat| {
        let state = stat
            .rsplit_once(')')
            .and_then(|(_, rest)| rest.split_whitespace().next());
        state != Some("Z")
    })
}

/// Waits for something to become true.
///
/// # Panics
/// If it does not within `limit`.
pub fn wait_until(what: &str, limit: Duration, mut is_true: impl FnMut() -> bool) {
    let begun = Instant::now();
    while !is_true() {
        assert!(begun.elapsed() < limit, "not within {limit:?}: {what}");
        thread::sleep(Duration::from_millis(5));
    }
}
