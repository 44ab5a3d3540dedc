//! Tests on four hosts with a real sshd each, in namespaces of this machine: connected by a virtual cable,
//! with their own processes, host name and an empty home.
//!
//! Needs Linux, root, iproute2 and openssh-server; skipped with a message where these are missing.
use super::*;
use std::{
    io::{BufRead, BufReader},
    process::Stdio,
    thread,
    time::{Duration, Instant},
};
use tests::{
    namespace::{HEAD, NODE, Namespaces},
    process::Process,
};

const LIMIT: Duration = Duration::from_mins(1);
const SSHD: &str = "/usr/sbin/sshd";
/// Port of the coordinator. `HOSTS` are the sshd ports of the hosts.
const PORT: u16 = 7447;
const HOSTS: [u16; 4] = [2201, 2202, 2203, 2204];
/// Number of jobs. With `DELAY_MS` per job, the run takes some 25 s on eight slots.
const JOBS: &str = "1000";
const DELAY_MS: &str = "200";

/// Creates the network namespaces called head and node, and a test folder whose ssh reaches hosts on the
/// node; returns `None` after [`tests::skip`] where this machine does not allow them.
pub(super) fn network() -> Option<(Namespaces, Site)> {
    if !Path::new(SSHD).exists() {
        tests::skip("openssh-server is not installed");
        return None;
    }
    let namespaces = Namespaces::make()?;
    let site = Site::with_host(1, HEAD);
    configure(&site);
    Some((namespaces, site))
}

/// Writes the keys and configuration of the SSH servers and of their client.
fn configure(site: &Site) {
    let path = |name: &str| site.path(name).display().to_string();
    for key in ["host_key", "user_key"] {
        let words = ["-q", "-t", "ed25519", "-N", "", "-f", &path(key)];
        let made = Command::new("ssh-keygen").args(words).status();
        assert!(made.unwrap().success());
    }
    let server = format!(
        "HostKey {}\nAuthorizedKeysFile {}\nStrictModes no\nUsePAM no\nPermitRootLogin yes\n\
         PidFile none\nSubsystem sftp internal-sftp\n",
        path("host_key"),
        path("user_key.pub")
    );
    fs::write(site.path("sshd_config"), server).unwrap();
    let client = format!(
        "IdentityFile {}\nUserKnownHostsFile {}\nStrictHostKeyChecking accept-new\n",
        path("user_key"),
        path("known_hosts")
    );
    fs::write(site.path("ssh_config"), client).unwrap();
    // the user's ssh, with a configuration that is the test's
    let ssh = format!(
        "#!/bin/sh\nexec /usr/bin/ssh -F {} \"$@\"\n",
        path("ssh_config")
    );
    fs::write(site.path("bin/ssh"), ssh).unwrap();
    // where sshd wants an empty folder
    fs::create_dir_all("/run/sshd").unwrap();
}

/// Starts a host: sshd in its own host name, mount and process namespaces, with 200 MB for its home.
pub(super) fn host(site: &Site, namespaces: &Namespaces, port: u16) -> Process {
    host_with_room(site, namespaces, port, 200)
}

/// Starts a host like [`host`] with a number of megabytes for its home.
pub(super) fn host_with_room(
    site: &Site,
    namespaces: &Namespaces,
    port: u16,
    megabytes: u32,
) -> Process {
    let script = format!(
        "hostname node{port} && mount -t tmpfs -o size={megabytes}m none /root && \
         exec {SSHD} -D -e -f {} -p {port}",
        site.path("sshd_config").display()
    );
    let mut command = namespaces.on_node(Path::new("unshare"));
    // the process namespace ends with the one that made it
    command.args([
        "-u",
        "-m",
        "-p",
        "-f",
        "--kill-child",
        "--mount-proc",
        "sh",
        "-c",
    ]);
    command.arg(script);
    Process::logged(command, &site.path(&format!("sshd{port}.log")))
}

/// Runs a `horsehead` command in the network namespace called head.
pub(super) fn on_head(site: &Site, namespaces: &Namespaces, words: &[&str]) -> Output {
    let mut command = namespaces.on_head(&coordinator_program());
    let path = std::env::var("PATH").unwrap();
    command
        .args(words)
        .current_dir(site.folder.path())
        .env("PATH", format!("{}:{path}", site.path("bin").display()));
    command.output().unwrap()
}

/// Runs a script on a host by ssh and returns its output.
pub(super) fn on_host(site: &Site, namespaces: &Namespaces, port: u16, script: &str) -> String {
    let mut command = namespaces.on_head(&site.path("bin/ssh"));
    command.args(["-p", &port.to_string(), &format!("root@{NODE}"), script]);
    let output = command.output().unwrap();
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

fn workers(site: &Site, namespaces: &Namespaces) -> Vec<Value> {
    let words = ["workers", "list", "--run", "run", "--output", "json"];
    let listed = on_head(site, namespaces, &words);
    let object: Value = serde_json::from_slice(&listed.stdout).unwrap_or_default();
    object["workers"].as_array().cloned().unwrap_or_default()
}

/// Polls the coordinator's list of workers until `is` holds for it.
fn until(site: &Site, namespaces: &Namespaces, what: &str, is: impl Fn(&[Value]) -> bool) {
    let begun = Instant::now();
    loop {
        let workers = workers(site, namespaces);
        if is(&workers) {
            return;
        }
        assert!(begun.elapsed() < LIMIT, "{what}: {workers:?}");
        thread::sleep(Duration::from_millis(100));
    }
}

#[test]
#[expect(
    clippy::too_many_lines,
    reason = "one story: what happens first matters to what happens then"
)]
fn four_hosts_come_up_by_ssh_and_a_run_outlives_what_happens_to_them() {
    let Some((namespaces, site)) = network() else {
        return;
    };
    let servers = HOSTS.map(|port| host(&site, &namespaces, port));
    let at = format!("quic/{HEAD}:{PORT}");
    let mut command = namespaces.on_head(Path::new(env!("CARGO_BIN_EXE_test-network-coordinator")));
    command
        .arg(site.path("run"))
        .arg(&at)
        .arg(site.path("keys"));
    command.args([JOBS, DELAY_MS]).stderr(Stdio::null());
    let mut coordinator = Process::start(command);
    let mut lines = BufReader::new(coordinator.output()).lines();

    let hosts = HOSTS.map(|port| format!("root@{NODE}:{port}"));
    let begun = Instant::now();
    let bring = || {
        let hosts = hosts.join(",");
        let words = [
            "workers",
            "up",
            "--connect",
            &at,
            "--tls",
            "keys",
            "--slots",
            "2",
            "--wait",
            "40",
            "--ssh",
            &hosts,
        ];
        on_head(&site, &namespaces, &words)
    };
    let up = bring();
    assert!(up.status.success(), "{}", errors(&up));
    eprintln!("four hosts up after {:?}", begun.elapsed());
    until(&site, &namespaces, "all four work", |workers| {
        let mut hosts: Vec<&str> = workers.iter().filter_map(|w| w["host"].as_str()).collect();
        hosts.sort_unstable();
        hosts == ["node2201", "node2202", "node2203", "node2204"]
            && workers.iter().all(|worker| worker["state"] == "working")
    });

    // one finishes and gets no more, one is killed, and the cable is pulled and put back
    let drain = ["workers", "drain", "node2201", "--run", "run"];
    let drained = on_head(&site, &namespaces, &drain);
    assert!(drained.status.success(), "{}", errors(&drained));
    let killed = namespaces
        .on_head(&site.path("bin/ssh"))
        .args(["-p", "2202", &format!("root@{NODE}")])
        .arg("kill -9 $(cat .cache/horsehead/worker-*/process)")
        .output()
        .unwrap();
    assert!(killed.status.success(), "{}", errors(&killed));
    until(
        &site,
        &namespaces,
        "it is lost, the other drained",
        |workers| {
            let is = |worker: &Value| worker["host"] == "node2201" && worker["state"] == "drained";
            workers.len() == 3 && workers.iter().any(is)
        },
    );
    namespaces.plug(false);
    thread::sleep(Duration::from_secs(6));
    assert!(workers(&site, &namespaces).is_empty(), "the cable is out");
    namespaces.plug(true);
    until(&site, &namespaces, "they are back", |workers| {
        workers.len() == 3
    });
    // the one that was killed comes back by the same command, which leaves the others alone
    let again = bring();
    assert!(again.status.success(), "{}", errors(&again));

    // the coordinator has compared every result with the one that its job must have
    let end = lines
        .by_ref()
        .map_while(Result::ok)
        .find(|line| line.starts_with("end "));
    let end = end.unwrap();
    assert!(end.contains(&format!("done {JOBS} ")), "{end}");
    assert_eq!(coordinator.wait(LIMIT), Some(0));
    eprintln!("{end}");
    let down = on_head(
        &site,
        &namespaces,
        &["workers", "down", "--ssh", &hosts.join(",")],
    );
    assert!(down.status.success(), "{}", errors(&down));
    drop(servers);
}
