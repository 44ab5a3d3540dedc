//! Tests of admission: workers with valid certificates are admitted, others are refused, and both ends report
//! the reason.
use super::{LIMIT, compute, options, worker};
use dispatch::runtime::{Dispatch, DispatchError};
use link::keys::authority::{Authority, Validity};
use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
    time::{Duration, Instant, SystemTime},
};
use tests::{
    expect_results,
    keys::{make, raw_session},
    process::{
        Process, children, coordinator_program, free_locator, free_quic_locator, free_tcp_locator,
        wait_until, worker_program,
    },
};

/// Time within which a refusal must be reported: at the first attempt, not after the many retries of a worker
/// that gets no answer.
const AT_ONCE: Duration = Duration::from_secs(15);

/// Checks that the jobs of a run are computed by two workers with the same certificate, one with another, and
/// a local worker without a certificate.
#[tokio::test(flavor = "multi_thread")]
async fn a_run_is_done_by_workers_with_certificates() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let locator = free_quic_locator();
    let options = options(&folder.path().join("run"), &locator, &keys, 1);
    let mut dispatch = Dispatch::open(options).await.unwrap();
    let names = ["worker-01", "worker-01", "worker-02"];
    let workers = names.map(|name| {
        let tls = Some(keys.join(name));
        Process::start(worker(&locator, tls, &["--slots", "2"]))
    });
    wait_until("all have joined", LIMIT, || {
        dispatch.snapshot().workers.len() == 4
    });
    let results = compute(&mut dispatch, 400, 5).await;
    expect_results(&results, 400);
    let snapshot = dispatch.snapshot();
    let everybody = snapshot.workers.iter().filter(|worker| worker.done > 0);
    assert_eq!(everybody.count(), 4, "{snapshot:?}");
    let summary = dispatch.close().await.unwrap();
    assert_eq!((summary.last.lost, summary.last.failed), (0, 0));
    drop(workers);
}

/// Starts a worker that must be refused; returns its exit code, its log and the time taken.
fn refused(folder: &Path, locator: &str, tls: Option<&Path>) -> (Option<i32>, String, Duration) {
    let log = folder.join("worker.log");
    let command = worker(locator, tls.map(Path::to_owned), &["--slots", "1"]);
    let begun = Instant::now();
    let code = Process::logged(command, &log).wait(LIMIT);
    (code, fs::read_to_string(log).unwrap(), begun.elapsed())
}

#[tokio::test(flavor = "multi_thread")]
async fn a_wrong_certificate_is_refused_within_a_second_with_the_reason() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    worker_program();
    let authority = make(&at("keys"), &[]);
    make(&at("other"), &[]);
    let locator = free_quic_locator();
    let options = options(&at("run"), &locator, &at("keys"), 0);
    let dispatch = Dispatch::open(options).await.unwrap();

    let past = SystemTime::now() - Duration::from_hours(24);
    let expired = Validity {
        from: past - Duration::from_hours(24),
        until: past,
    };
    let old = authority.issue_worker("old", expired).unwrap();
    // signed by this authority after the coordinator read its list
    let late = authority.issue_worker("late", Validity::days(1)).unwrap();
    // trusts the right authority, but shows a certificate of another
    let mixed = at("other").join("worker-02");
    let foreign = at("other").join("worker-01");
    for (case, tls, words) in [
        (
            "another authority",
            Some(&foreign),
            "signed by another authority than",
        ),
        ("no certificate", None, "needs certificates: give --tls DIR"),
        (
            "out of date",
            Some(&old),
            "old/worker.pem is out of date since",
        ),
        (
            "not on the list",
            Some(&late),
            "\"late\": its list of workers does not hold",
        ),
    ] {
        let (code, said, took) = refused(folder.path(), &locator, tls.map(PathBuf::as_path));
        assert_eq!(code, Some(3), "{case}: {said}");
        assert!(said.contains("refused: "), "{case}: {said}");
        assert!(said.contains(words), "{case}: {said}");
        assert!(took < AT_ONCE, "{case}: {took:?}");
    }
    fs::copy(at("keys").join("ca.pem"), mixed.join("ca.pem")).unwrap();
    let (code, said, _) = refused(folder.path(), &locator, Some(&mixed));
    assert_eq!(code, Some(3), "{said}");
    assert!(
        said.contains("worker.pem was not signed by the authority of"),
        "{said}"
    );
    assert!(dispatch.snapshot().workers.is_empty());
    dispatch.close().await.unwrap();
}

/// Checks that a worker does not trust a coordinator whose certificate is not for the dialled host.
#[tokio::test(flavor = "multi_thread")]
async fn a_coordinator_of_another_name_is_not_trusted() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    let authority = Authority::create(&keys).unwrap();
    let valid = Validity::days(1);
    let hosts = ["head.example".to_owned()];
    authority.issue_coordinator(&hosts, valid).unwrap();
    let tls = authority.issue_worker("worker-01", valid).unwrap();
    let locator = free_quic_locator();
    let options = options(&folder.path().join("run"), &locator, &keys, 0);
    let dispatch = Dispatch::open(options).await.unwrap();
    let (code, said, took) = refused(folder.path(), &locator, Some(&tls));
    assert_eq!(code, Some(3), "{said}");
    for words in [
        "its certificate is not for \"127.0.0.1\"",
        "head.example",
        "--host",
    ] {
        assert!(said.contains(words), "{said}");
    }
    assert!(took < AT_ONCE, "{took:?}");
    dispatch.close().await.unwrap();
}

/// Checks that the coordinator logs why it refuses a raw client, and that no private key appears in its log,
/// arguments or run folder.
#[tokio::test(flavor = "multi_thread")]
async fn the_coordinator_says_why_it_refuses_a_connection() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let authority = make(&at("keys"), &[]);
    make(&at("other"), &[]);
    let past = SystemTime::now() - Duration::from_hours(24);
    let expired = Validity {
        from: past - Duration::from_hours(24),
        until: past,
    };
    let old = authority.issue_worker("old", expired).unwrap();
    let foreign = at("other").join("worker-01");
    fs::copy(at("keys").join("ca.pem"), foreign.join("ca.pem")).unwrap();

    let locator = free_quic_locator();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let mut command = Command::new(coordinator_program());
    command
        .arg("calibrate")
        .arg(case)
        .arg("--run")
        .arg(at("run"));
    command.args(["--workers", "0", "--listen", &locator, "--tls"]);
    command.arg(at("keys"));
    let log = at("coordinator.log");
    let coordinator = Process::logged(command, &log);
    let said = || fs::read_to_string(&log).unwrap();
    wait_until("it waits for workers", LIMIT, || said().contains("waiting"));
    for (tls, with_certificate, words) in [
        (
            &foreign,
            true,
            "refused: its certificate was signed by another authority",
        ),
        (&old, true, "refused: its certificate is out of date"),
        (&old, false, "refused: it showed no certificate"),
    ] {
        let begun = Instant::now();
        let opened = raw_session(&locator, tls, with_certificate, 900).await;
        assert!(opened.is_err(), "{words}: got in");
        wait_until(words, AT_ONCE, || said().contains(words));
        assert!(begun.elapsed() < AT_ONCE, "{words}");
    }
    let secret = fs::read_to_string(at("keys").join("coordinator.key")).unwrap();
    let secret = secret.lines().nth(1).unwrap();
    assert!(!said().contains(secret), "a key in the log");
    let arguments = fs::read(format!(
        "/proc/{}/cmdline",
        coordinator.pid().as_raw_nonzero()
    ));
    assert!(!String::from_utf8_lossy(&arguments.unwrap()).contains(secret));
    drop(coordinator);
    let journal = fs::read_dir(at("run")).unwrap().flatten();
    for file in journal.filter(|file| file.path().is_file()) {
        let bytes = fs::read(file.path()).unwrap();
        assert!(
            !String::from_utf8_lossy(&bytes).contains(secret),
            "{:?}",
            file.path()
        );
    }
}

/// Checks that a coordinator listens nowhere without certificates unless it is told to.
#[tokio::test(flavor = "multi_thread")]
async fn nothing_is_listened_on_without_certificates() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    for (locator, words) in [
        ("tcp/0.0.0.0:0", "say --insecure"),
        ("tcp/127.0.0.1:0", "say --insecure"),
        ("unix//tmp/bus", "other users can enter /tmp"),
        ("quic/127.0.0.1:0", "give --tls DIR"),
    ] {
        let mut options = tests::options(&run, Some(locator), 0);
        options.access.insecure = false;
        let opened = Dispatch::open(options).await;
        let error = opened.err().map(|error: DispatchError| error.to_string());
        assert!(
            error.as_ref().is_some_and(|text| text.contains(words)),
            "{error:?}"
        );
        assert!(!run.exists(), "nothing is made for a run that cannot begin");
    }
}

/// Checks that a worker that cannot connect logs the reason and tries again.
#[test]
fn a_worker_says_what_keeps_it_from_its_coordinator() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let tls = keys.join("worker-01");
    let closed = free_quic_locator();
    let (plain, socket) = (free_tcp_locator(), free_locator());
    for (locator, words) in [
        (closed.as_str(), "UDP port closed"),
        ("quic/no.such.host.invalid:7447", "cannot find the host"),
        (plain.as_str(), "TCP port closed"),
        (socket.as_str(), "no coordinator listens on that socket"),
    ] {
        let log = folder.path().join("worker.log");
        let command = worker(locator, Some(tls.clone()), &["--slots", "1"]);
        let mut process = Process::logged(command, &log);
        wait_until(words, LIMIT, || {
            fs::read_to_string(&log).unwrap().contains(words)
        });
        let said = fs::read_to_string(&log).unwrap();
        assert!(said.contains("trying again until it answers"), "{said}");
        process.signal(rustix::process::Signal::TERM);
        assert_eq!(process.wait(LIMIT), Some(0), "{said}");
    }
}

/// Checks that a worker's private key appears neither in its debug log nor in the arguments and environment
/// of its processes.
#[tokio::test(flavor = "multi_thread")]
async fn a_worker_keeps_its_key_to_itself() {
    let folder = tempfile::tempdir().unwrap();
    let keys = folder.path().join("keys");
    make(&keys, &[]);
    let locator = free_quic_locator();
    let options = options(&folder.path().join("run"), &locator, &keys, 0);
    let mut dispatch = Dispatch::open(options).await.unwrap();
    let tls = keys.join("worker-01");
    let mut command = worker(&locator, Some(tls.clone()), &["--slots", "1"]);
    command.env("HORSEHEAD_LOG", "debug");
    let log = folder.path().join("worker.log");
    let process = Process::logged(command, &log);
    let results = compute(&mut dispatch, 20, 1).await;
    expect_results(&results, 20);
    let key = fs::read_to_string(tls.join(link::keys::WORKER[1])).unwrap();
    let secrets: Vec<&str> = key.lines().filter(|it| !it.starts_with("-----")).collect();
    assert!(!secrets.is_empty(), "{key}");
    let mut shown = vec![fs::read_to_string(&log).unwrap()];
    assert!(shown[0].contains("DEBUG"), "{}", shown[0]);
    for pid in [process.pid()].into_iter().chain(children(process.pid())) {
        for what in ["cmdline", "environ"] {
            let path = format!("/proc/{}/{what}", pid.as_raw_nonzero());
            shown.push(String::from_utf8_lossy(&fs::read(path).unwrap()).into_owned());
        }
    }
    assert!(shown.len() >= 5, "the worker and its slot");
    for (text, secret) in shown
        .iter()
        .flat_map(|text| secrets.iter().map(move |it| (text, it)))
    {
        assert!(!text.contains(secret), "a key in {text}");
    }
    dispatch.close().await.unwrap();
}
