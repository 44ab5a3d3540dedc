//! Test of a run that launched its own workers over a real sshd, was killed, and is resumed by the same
//! command.
use super::{
    machines::{host, network, on_head, on_host},
    *,
};
use rustix::process::Signal;
use std::{
    thread,
    time::{Duration, Instant},
};
use tests::{
    namespace::{HEAD, NODE, Namespaces},
    process::Process,
};

const LIMIT: Duration = Duration::from_mins(1);
const PORTS: [u16; 2] = [2201, 2202];

/// Writes the shipped case with long cylinders, so that a simulation takes some 25 ms.
pub(super) fn make_case(site: &Site) {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
    let mut copy = Command::new("cp");
    copy.arg("-r").arg(&shipped).arg(site.path("case"));
    assert!(copy.status().unwrap().success());
    let file = site.path("case/case.toml");
    let text = fs::read_to_string(&file).unwrap();
    let mut long = text;
    for (short, longer) in [
        ("\ncylinder_length_m = 0.050", "\ncylinder_length_m = 0.150"),
        ("\nback_cylinders = 72", "\nback_cylinders = 24"),
        ("\nfront_cylinders = 114", "\nfront_cylinders = 38"),
    ] {
        assert!(long.contains(short), "{short}");
        long = long.replace(short, longer);
    }
    fs::write(file, long).unwrap();
}

/// Returns the digest of the evaluation log that a calibration printed.
fn digest(output: &Output) -> String {
    assert!(output.status.success(), "{}", errors(output));
    let object: Value = serde_json::from_slice(&output.stdout).unwrap();
    object["log_digest"].as_str().unwrap().to_owned()
}

/// Returns the process ids of workers on a host.
fn processes(site: &Site, namespaces: &Namespaces, port: u16) -> Vec<String> {
    // slots are children of the same program
    let script = "for process in /proc/[0-9]*; do \
                  case $(tr '\\0' ' ' < $process/cmdline 2>/dev/null) in \
                  /*/worker-*' --connect '*) echo ${process#/proc/} ;; esac; done";
    let found = on_host(site, namespaces, port, script);
    found.split_whitespace().map(str::to_owned).collect()
}

#[test]
#[expect(
    clippy::too_many_lines,
    reason = "one story: what happens first matters to what happens then"
)]
fn the_same_command_goes_on_and_ends_its_own_workers_alone() {
    let Some((namespaces, site)) = network() else {
        return;
    };
    make_case(&site);
    let _servers = PORTS.map(|port| host(&site, &namespaces, port));
    let search = "calibrate case --preset random --set points=200 --seed 5 --output json";
    let search: Vec<&str> = search.split(' ').collect();
    let alone = [&search[..], &["--workers", "2", "--run", "alone"]].concat();
    let expected = digest(&on_head(&site, &namespaces, &alone));

    // somebody else's worker, of another coordinator that does not run
    let [first, second] = PORTS.map(|port| format!("root@{NODE}:{port}"));
    let at = format!("quic/{HEAD}:7999");
    let words = [
        "workers",
        "up",
        "--connect",
        &at,
        "--tls",
        "keys",
        "--wait",
        "0",
        "--ssh",
        &first,
    ];
    let other = on_head(&site, &namespaces, &words);
    assert!(other.status.success(), "{}", errors(&other));
    let others = processes(&site, &namespaces, PORTS[0]);
    assert_eq!(others.len(), 1);

    let hosts = format!("{first},{second}");
    let words = [
        &search[..],
        &["--workers", "0", "--run", "run", "--ssh", &hosts],
    ]
    .concat();
    let mut command = namespaces.on_head(&coordinator_program());
    let path = std::env::var("PATH").unwrap();
    command
        .args(&words)
        .current_dir(site.folder.path())
        .env("PATH", format!("{}:{path}", site.path("bin").display()));
    let coordinator = Process::logged(command, &site.path("coordinator.log"));
    let begun = Instant::now();
    loop {
        let words = ["workers", "list", "--run", "run", "--output", "json"];
        let listed = on_head(&site, &namespaces, &words);
        let object: Value = serde_json::from_slice(&listed.stdout).unwrap_or_default();
        let workers = object["workers"].as_array().cloned().unwrap_or_default();
        let done = |worker: &Value| worker["done"].as_u64() > Some(10);
        if workers.len() == 2 && workers.iter().all(done) {
            break;
        }
        let log = || fs::read_to_string(site.path("coordinator.log")).unwrap();
        assert!(begun.elapsed() < LIMIT, "{workers:?}: {}", log());
        thread::sleep(Duration::from_millis(50));
    }
    coordinator.signal(Signal::KILL);
    drop(coordinator);
    // one of the workers outlives it, the other does not
    let left = processes(&site, &namespaces, PORTS[0]);
    assert_eq!(left.len(), 2);
    let killed = on_host(
        &site,
        &namespaces,
        PORTS[1],
        "kill -9 $(cat .cache/horsehead/worker-*/process); echo done",
    );
    assert_eq!(killed, "done");
    let launched = ".cache/horsehead/worker-*/process";
    let before = on_host(&site, &namespaces, PORTS[0], &format!("cat {launched}"));

    let again = on_head(&site, &namespaces, &words);
    assert_eq!(digest(&again), expected);
    let said = errors(&again);
    assert!(said.contains("going on with run"), "{said}");
    for host in [&first, &second] {
        assert!(said.contains(&format!("{host}: takes part as ")), "{said}");
    }
    // the worker that outlived the coordinator was taken back: no other one was started there
    let after = on_host(&site, &namespaces, PORTS[0], &format!("cat {launched}"));
    assert_eq!(after, before);
    assert_eq!(processes(&site, &namespaces, PORTS[0]), others);
    assert_eq!(processes(&site, &namespaces, PORTS[1]), [""; 0]);

    // and after its end
    assert_eq!(digest(&on_head(&site, &namespaces, &words)), expected);
    assert_eq!(processes(&site, &namespaces, PORTS[0]), others);
    assert_eq!(processes(&site, &namespaces, PORTS[1]), [""; 0]);
}
