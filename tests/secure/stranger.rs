//! Tests of what another user of the machine can reach of a run with workers on this machine.
use rustix::process::Pid;
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    path::Path,
    process::Command,
    time::{Duration, Instant},
};
use tests::{
    process::{
        Process, children, command_line, coordinator_program, free_quic_locator, wait_until,
        worker_program,
    },
    stranger::as_stranger,
};

const LIMIT: Duration = Duration::from_mins(1);

/// Returns the TCP ports on which a process listens.
fn listening_ports(process: Pid) -> Vec<String> {
    let at = format!("/proc/{}", process.as_raw_nonzero());
    let open: Vec<String> = fs::read_dir(format!("{at}/fd"))
        .unwrap()
        .filter_map(|file| fs::read_link(file.ok()?.path()).ok())
        .map(|target| target.display().to_string())
        .collect();
    let mut ports = Vec::new();
    for table in ["tcp", "tcp6"] {
        let table = fs::read_to_string(format!("{at}/net/{table}")).unwrap_or_default();
        for line in table.lines().skip(1) {
            let fields: Vec<&str> = line.split_whitespace().collect();
            let (local, state, inode) = (fields[1], fields[3], fields[9]);
            // 0A: it listens
            if state == "0A" && open.contains(&format!("socket:[{inode}]")) {
                ports.push(local.to_owned());
            }
        }
    }
    ports
}

/// Waits for the local worker of a coordinator and returns the address to which it connects.
fn address_of_worker(coordinator: &Process) -> String {
    let mut address = None;
    wait_until("a local worker runs", LIMIT, || {
        let workers = children(coordinator.pid());
        address = workers.into_iter().find_map(|pid| {
            let words = command_line(pid);
            let at = words.iter().position(|word| word == "--connect")?;
            words.get(at + 1).cloned()
        });
        address.is_some()
    });
    address.unwrap()
}

/// Checks that another user of the machine can neither find a port of a run nor connect to its socket. Regression: on
/// `tcp/127.0.0.1`, where local workers connected, he read every frame and delivered results of his own.
#[test]
fn a_stranger_reaches_no_run_whose_workers_are_on_this_machine() {
    let folder = tempfile::tempdir().unwrap();
    let open = |path: &Path| {
        fs::set_permissions(path, fs::Permissions::from_mode(0o755)).unwrap();
    };
    open(folder.path());
    let program = folder.path().join("worker");
    fs::copy(worker_program(), &program).unwrap();
    open(&program);
    let (run, log) = (
        folder.path().join("run"),
        folder.path().join("coordinator.log"),
    );
    let mut command = Command::new(env!("CARGO_BIN_EXE_test-coordinator"));
    command.arg(&run).args(["none", "300", "20", "1"]);
    let mut coordinator = Process::logged(command, &log);
    let address = address_of_worker(&coordinator);
    let path = address.strip_prefix("unix/").unwrap();
    let socket = fs::metadata(Path::new(path).parent().unwrap()).unwrap();
    assert_eq!(socket.permissions().mode() & 0o777, 0o700);
    assert_eq!(listening_ports(coordinator.pid()), [""; 0]);
    let Some(mut stranger) = as_stranger(&program) else {
        return;
    };
    stranger.args(["--connect", &address, "--slots", "1"]);
    let heard = folder.path().join("stranger.log");
    let stranger = Process::logged(stranger, &heard);
    wait_until("the stranger is refused", LIMIT, || {
        fs::read_to_string(&heard)
            .unwrap()
            .contains("Permission denied")
    });
    assert_eq!(coordinator.wait(LIMIT), Some(0));
    let said = fs::read_to_string(&heard).unwrap();
    assert!(!said.contains("connected"), "{said}");
    drop(stranger);
}

/// Checks the same for a run that takes workers of other machines: its local workers use the socket, too.
#[test]
fn a_run_with_certificates_has_no_other_way_in() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    tests::keys::make(&keys, &[]);
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let mut command = Command::new(coordinator_program());
    command
        .arg("calibrate")
        .arg(case)
        .args(["--preset", "random", "--workers", "1", "--run", "run"])
        .args(["--listen", &free_quic_locator(), "--tls"])
        .arg(&keys)
        .current_dir(folder.path());
    let coordinator = Process::logged(command, &folder.path().join("log"));
    let address = address_of_worker(&coordinator);
    assert!(address.starts_with("unix/"), "{address}");
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(1) {
        assert_eq!(listening_ports(coordinator.pid()), [""; 0]);
    }
}
