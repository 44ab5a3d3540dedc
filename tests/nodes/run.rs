//! Test of launching, draining, expelling and stopping workers during a run.
use super::*;
use dispatch::runtime::Dispatch;
use journal::event::JobReason;
use protocol::id::JobId;
use std::time::{Duration, Instant};

const LIMIT: Duration = Duration::from_secs(40);

/// Opens a run that accepts remote workers, with jobs that each take `delay_ms`.
async fn open(site: &Site, jobs: u64, delay_ms: u32) -> Dispatch {
    let mut options = tests::options(&site.path("run"), Some(&site.locator), 0);
    options.access.tls = Some(site.path("keys"));
    let mut run = Dispatch::open(options).await.unwrap();
    for n in 0..jobs {
        run.submit(JobId(n), tests::job(n, delay_ms), JobReason::default())
            .unwrap();
    }
    run
}

/// Polls the coordinator's list of workers until `is` holds for it; returns the time taken.
async fn until(site: &Site, what: &str, is: impl Fn(&[Value]) -> bool) -> Duration {
    let begun = Instant::now();
    loop {
        let workers = site.list();
        if is(&workers) {
            return begun.elapsed();
        }
        assert!(begun.elapsed() < LIMIT, "{what}: {workers:?}");
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
}

fn named<'a>(workers: &'a [Value], name: &str) -> Option<&'a Value> {
    workers.iter().find(|worker| worker["name"] == name)
}

#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
#[expect(
    clippy::too_many_lines,
    reason = "one story: what happens first matters to what happens then"
)]
async fn workers_come_up_are_listed_drained_thrown_out_and_ended_without_a_restart() {
    let site = Site::new(1);
    let jobs = 400;
    let mut run = open(&site, jobs, 100).await;

    // one folder of keys is there; the second host gets a new one, and the run takes its name
    let up = ["--ssh", "a,b", "--slots", "2", "--wait", "30"];
    let came = site.up(&up);
    assert!(came.status.success(), "{}", errors(&came));
    assert!(
        errors(&came).contains("a: takes part as worker-01"),
        "{}",
        errors(&came)
    );
    until(&site, "both work", |workers| {
        workers.len() == 2 && workers.iter().all(|worker| worker["state"] == "working")
    })
    .await;
    let workers = site.list();
    for name in ["worker-01", "worker-02"] {
        let worker = named(&workers, name).unwrap();
        assert_eq!(worker["slots"], 2);
        let version = worker["version"].as_str().unwrap();
        assert!(version.starts_with(env!("CARGO_PKG_VERSION")), "{version}");
        assert!(worker["last_seen_s"].as_f64().unwrap() < 4.0, "{worker}");
    }
    // what lies on a host is for its owner alone
    let keys = site.at("b", "worker-02");
    assert_eq!(
        fs::metadata(keys).unwrap().permissions().mode() & 0o777,
        0o700
    );
    let socket = fs::metadata(site.path("run/workers.sock")).unwrap();
    assert_eq!(socket.permissions().mode() & 0o777, 0o600);

    // the same again changes nothing
    let before = site.process("a", "worker-01");
    let again = site.up(&up);
    assert!(again.status.success(), "{}", errors(&again));
    assert_eq!(site.process("a", "worker-01"), before);

    // hands back within a second
    let asked = Instant::now();
    let drained = site.horsehead(&["workers", "drain", "worker-01", "--now", "--run", "run"]);
    assert!(drained.status.success(), "{}", errors(&drained));
    until(&site, "it holds nothing", |workers| {
        named(workers, "worker-01").is_some_and(|worker| worker["state"] == "drained")
    })
    .await;
    assert!(
        asked.elapsed() < Duration::from_secs(1),
        "{:?}",
        asked.elapsed()
    );

    // a name that is taken off the list is out within five seconds, whatever it holds
    let list = site.path("keys/workers");
    let names = fs::read_to_string(&list).unwrap();
    fs::write(&list, names.replace("worker-02\n", "")).unwrap();
    let out = until(&site, "it is out", |workers| {
        named(workers, "worker-02").is_none()
    })
    .await;
    assert!(out < Duration::from_secs(5), "{out:?}");

    // another one finishes the work
    let came = site.up(&["--ssh", "c", "--slots", "4", "--wait", "30"]);
    assert!(came.status.success(), "{}", errors(&came));
    // the folders of the others are given away, and the name that was struck is not given again
    let name = "worker-03";
    let mut seen = 0;
    let all = async {
        while seen < jobs {
            run.next().await.unwrap();
            seen += 1;
        }
    };
    let in_time = tokio::time::timeout(Duration::from_mins(2), all).await;
    assert!(in_time.is_ok(), "{seen} of {jobs} results");

    let status = fs::read_to_string(site.at("c", name).join("status")).unwrap();
    assert_eq!(status, "admitted\n");
    let logs = site.horsehead(&["workers", "logs", name, "--tls", "keys"]);
    assert!(
        String::from_utf8_lossy(&logs.stdout).contains("connected to"),
        "{}",
        errors(&logs)
    );
    let process = site.process("c", name);
    assert!(runs(&process));
    let down = site.horsehead(&["workers", "down", name, "--run", "run"]);
    assert!(down.status.success(), "{}", errors(&down));
    let begun = Instant::now();
    while runs(&process) {
        assert!(begun.elapsed() < LIMIT, "it was asked to end");
        tokio::time::sleep(Duration::from_millis(50)).await;
    }
    // by its process, whatever it does: the one that was thrown out dials in vain
    let process = site.process("b", "worker-02");
    // one that a run launched is that run's, unless all are meant
    let owner = site.at("b", "worker-02").join("owner");
    assert_eq!(fs::read_to_string(&owner).unwrap(), "\n");
    fs::write(&owner, "another run\n").unwrap();
    let down = site.horsehead(&["workers", "down", "--ssh", "b"]);
    assert!(down.status.success(), "{}", errors(&down));
    assert!(runs(&process));
    let down = site.horsehead(&["workers", "down", "--all", "--ssh", "b"]);
    assert!(down.status.success(), "{}", errors(&down));
    assert!(!runs(&process));

    run.close().await.unwrap();
    let nobody = site.horsehead(&["workers", "list", "--run", "run"]);
    assert_eq!(nobody.status.code(), Some(2));
    assert!(
        errors(&nobody).contains("no `horsehead` process is working on the run"),
        "{}",
        errors(&nobody)
    );
}

/// Checks that workers which the run started on its own machine end only with `--all`.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn the_workers_of_the_run_itself_end_only_with_all() {
    let site = Site::new(1);
    let mut run = Dispatch::open(tests::options(&site.path("run"), None, 1))
        .await
        .unwrap();
    run.submit(JobId(0), tests::job(0, 10), JobReason::default())
        .unwrap();
    run.next().await.unwrap();
    let workers = site.list();
    assert_eq!(
        (workers.len(), &workers[0]["local"]),
        (1, &true.into()),
        "{workers:?}"
    );
    let down = site.horsehead(&["workers", "down", "--run", "run"]);
    assert!(down.status.success(), "{}", errors(&down));
    assert!(
        errors(&down).contains("--all ends them too"),
        "{}",
        errors(&down)
    );
    assert_eq!(site.list()[0]["state"], "working");
    let down = site.horsehead(&["workers", "down", "--all", "--run", "run"]);
    assert!(down.status.success(), "{}", errors(&down));
    assert!(errors(&down).contains(" ends"), "{}", errors(&down));
    run.close().await.unwrap();
}
