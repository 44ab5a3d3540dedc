//! Test of every command that computes on spare nodes, between four hosts in namespaces of their own with a real
//! sshd each: results as on one machine, and hosts that cannot take part.
use super::{
    machines::{host, host_with_room, network, on_head, on_host},
    *,
};
use link::keys::authority::{Authority, Validity};
use oscillator::{case_folder, effect::Effects};
use serde_json::json;
use std::{
    collections::BTreeMap,
    process::Stdio,
    time::{Duration, Instant, SystemTime},
};
use tests::{
    namespace::{HEAD, NODE, Namespaces},
    process::{Process, worker_program},
};

const HOSTS: [u16; 4] = [2201, 2202, 2203, 2204];
const DAY: Duration = Duration::from_hours(24);

/// Hosts with the oscillator's case, whose simulations take a millisecond.
struct Spare {
    site: Site,
    namespaces: Namespaces,
    worker: PathBuf,
    _servers: Vec<Process>,
}

impl Spare {
    /// Starts four hosts, of which the last one has no room for a program if `full` is set.
    fn start(full: bool) -> Option<Self> {
        let (namespaces, site) = network()?;
        let effects = Effects {
            friction_n: case_folder::FRICTION_N,
            ..Effects::default()
        };
        case_folder::write(&site.path("case"), &case_folder::HIDDEN, &effects, 0).unwrap();
        let servers = HOSTS.map(|port| match port {
            2204 if full => host_with_room(&site, &namespaces, port, 1),
            _ => host(&site, &namespaces, port),
        });
        let worker = coordinator_program().with_file_name("test-oscillator-worker");
        assert!(worker.exists(), "run `cargo build` first");
        Some(Self {
            site,
            namespaces,
            worker,
            _servers: servers.into(),
        })
    }

    /// Returns a `horsehead` command on the head with the oscillator's worker as the worker of this machine.
    fn command(&self, words: &[&str]) -> Command {
        let worker = format!("HORSEHEAD_WORKER={}", self.worker.display());
        let program = coordinator_program();
        let path = format!(
            "PATH={}:{}",
            self.site.path("bin").display(),
            std::env::var("PATH").unwrap()
        );
        let mut command = self.namespaces.on_head(Path::new("env"));
        command
            .args([&worker, &path])
            .arg(program)
            .args(words)
            .current_dir(self.site.folder.path());
        command
    }

    fn run(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    fn json(&self, words: &[&str]) -> Value {
        let output = self.run(&[words, &["--output", "json"]].concat());
        assert!(output.status.success(), "{words:?}: {}", errors(&output));
        serde_json::from_slice(&output.stdout).unwrap()
    }
}

/// Returns the names of hosts as ssh takes them, with commas between.
fn hosts(ports: &[u16]) -> String {
    let names = ports.iter().map(|port| format!("root@{NODE}:{port}"));
    names.collect::<Vec<_>>().join(",")
}

/// Asserts that two printed objects are equal but for times, folders and what workers did.
fn assert_same(here: &Value, there: &Value) {
    let [here, there] = [here, there].map(|object| object.as_object().unwrap());
    assert_eq!(here.len(), there.len());
    for (key, own) in here {
        if !["run", "wall_s", "stages", "files", "command"].contains(&key.as_str()) {
            assert_eq!(Some(own), there.get(key), "{key}");
        }
    }
}

#[test]
fn every_command_on_four_hosts_gives_the_result_of_one_machine() {
    let Some(spare) = Spare::start(false) else {
        return;
    };
    let all = hosts(&HOSTS);
    let own = ["--workers", "2"];
    let remote = ["--workers", "0", "--ssh", &all];
    let prologue = spare.site.path("prologue");
    fs::write(&prologue, "touch ~/prologue\n").unwrap();
    let architecture = std::env::consts::ARCH;
    let program = format!("{architecture}={}", spare.worker.display());
    let calibrate = ["calibrate", "case", "--preset", "least-squares"];
    let alone = spare.json(&[&calibrate[..], &own, &["--run", "alone"]].concat());

    // the shipped worker is this machine's own here: the hosts have the named program
    let begun = Instant::now();
    let words = format!(
        "--run spare --slots 2 --prologue prologue --advertise {HEAD} --worker-program {program}"
    );
    let passed: Vec<&str> = words.split(' ').collect();
    let words = [&calibrate[..], &remote, &passed, &["--output", "json"]].concat();
    let output = on_head(&spare.site, &spare.namespaces, &words);
    let said = errors(&output);
    assert!(output.status.success(), "{said}");
    eprintln!("calibrated on four hosts within {:?}", begun.elapsed());
    assert!(said.contains("takes part as worker-0"), "{said}");
    let object: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_same(&object, &alone);
    for port in HOSTS {
        let script = "ls ~/prologue; cat ~/.cache/horsehead/worker-*/command";
        let found = on_host(&spare.site, &spare.namespaces, port, script);
        let wanted = ["/root/prologue", "--slots 2", &format!("quic/{HEAD}:7447")];
        assert!(wanted.iter().all(|part| found.contains(part)), "{found}");
    }

    write_individuals(&spare.site, &alone);
    // two hosts for the rest: what takes time here is ssh
    let two = hosts(&HOSTS[..2]);
    let remote = ["--workers", "0", "--ssh", &two];
    for command in [
        &["identify", "case"][..],
        &["diagnose", "case"],
        &["sweep", "individuals.csv", "--case", "case"],
    ] {
        let [here, there] = [("here", &own[..]), ("there", &remote)].map(|(run, workers)| {
            let run = format!("{}-{run}", command[0]);
            spare.json(&[command, workers, &["--run", &run]].concat())
        });
        assert_same(&here, &there);
    }
    let [here, there] = [("here", &own[..]), ("there", &remote)].map(|(run, workers)| {
        let run = format!("evaluate-{run}");
        let words = [&["evaluate", "case"][..], workers, &["--run", &run]].concat();
        let requests = spare.site.path("requests");
        let output = spare
            .command(&words)
            .stdin(fs::File::open(requests).unwrap())
            .output();
        let output = output.unwrap();
        assert!(output.status.success(), "{}", errors(&output));
        let printed = String::from_utf8(output.stdout).unwrap();
        let mut lines: Vec<String> = printed.lines().map(str::to_owned).collect();
        lines.sort();
        lines
    });
    assert_eq!((&here, here.len()), (&there, 5));

    check_scaling(&spare, &all);
    let by_hand = follow_readme(&spare);
    assert_eq!(by_hand["log_digest"], alone["log_digest"]);
    for port in HOSTS {
        // the worker that was started by hand stays for another run
        let script = "ls /proc/*/exe -l 2>/dev/null | grep -c cache/horsehead/worker || true";
        let left = on_host(&spare.site, &spare.namespaces, port, script);
        assert_eq!(left, "0", "workers are left on {port}");
    }
}

/// Follows the three commands of `deploy/README.md` for a worker that is started by hand, with another case,
/// and returns the object that the calibration prints.
fn follow_readme(spare: &Spare) -> Value {
    let deploy = Path::new(env!("CARGO_MANIFEST_DIR")).join("../deploy");
    let text = fs::read_to_string(deploy.join("README.md")).unwrap();
    let (_, text) = text.split_once("## By hand: three commands").unwrap();
    let (text, _) = text.split_once("\n## ").unwrap();
    let commands = text.lines().filter_map(|line| line.strip_prefix("    "));
    let commands = commands.map(|line| {
        line.replace("head.example", HEAD).replace(
            "cases/cyjs10-5-37hb --preset paper",
            "case --preset least-squares",
        )
    });
    let commands: Vec<String> = commands.collect();
    let [keys, calibrate, worker] = <[String; 3]>::try_from(commands).unwrap();
    let words = |line: &str| -> Vec<String> {
        let words = line.strip_prefix("horsehead ").unwrap().split(' ');
        words.map(str::to_owned).collect()
    };
    // those of the site
    fs::remove_dir_all(spare.site.path("keys")).unwrap();
    let keys = words(&keys);
    let keys: Vec<&str> = keys.iter().map(String::as_str).collect();
    let made = spare.run(&keys);
    assert!(made.status.success(), "{}", errors(&made));
    let mut calibrate = words(&calibrate);
    let own = ["--workers", "0", "--run", "by-hand", "--output", "json"];
    calibrate.extend(own.map(str::to_owned));
    let calibrate: Vec<&str> = calibrate.iter().map(String::as_str).collect();
    let mut calibrate = spare.command(&calibrate);
    calibrate.stdout(Stdio::piped()).stderr(Stdio::piped());
    let calibrating = calibrate.spawn().unwrap();

    // `scp -r keys/worker-01 NODE:`, with the port and the key of the test
    assert!(text.contains("`scp -r keys/worker-01 NODE:`"));
    // in place of `cargo install`
    fs::hard_link(&spare.worker, spare.site.path("horsehead-worker"))
        .or_else(|_| fs::copy(&spare.worker, spare.site.path("horsehead-worker")).map(drop))
        .unwrap();
    let mut copy = spare.namespaces.on_head(Path::new("scp"));
    let copied = copy
        .args(["-q", "-F", "ssh_config", "-P", "2201", "-r"])
        .args(["keys/worker-01", &format!("root@{NODE}:")])
        .current_dir(spare.site.folder.path())
        .status();
    assert!(copied.unwrap().success());
    let programs = spare.site.folder.path().display();
    let script = format!("(PATH={programs}:$PATH {worker} >by-hand.log 2>&1 &)");
    on_host(&spare.site, &spare.namespaces, HOSTS[0], &script);
    let output = calibrating.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Measures the scaling of two searches on two and on four of the hosts.
fn check_scaling(spare: &Spare, hosts: &str) {
    let words = "sweep scaling case --presets window,least-squares --evaluations 60 --crews 0 \
                 --slots 2 --nodes 2,4 --run scaling --ssh";
    let words: Vec<&str> = words.split_whitespace().chain([hosts]).collect();
    let object = spare.json(&words);
    let rows = object["rows"].as_array().unwrap();
    let rows = rows.iter().map(|row| {
        let [how, preset] = ["how", "preset"].map(|key| row[key].as_str().unwrap());
        (how, preset, row["slots"].as_u64().unwrap())
    });
    assert_eq!(
        rows.collect::<Vec<_>>(),
        [
            ("remote", "window", 4),
            ("remote", "least-squares", 4),
            ("remote", "window", 8),
            ("remote", "least-squares", 8),
        ]
    );
}

/// Writes individuals beside the result of a calibration: as a table, and as requests to `evaluate`.
fn write_individuals(site: &Site, calibrated: &Value) {
    let unknowns = ["mass", "left", "damping", "lead"];
    let values = unknowns.map(|name| calibrated["unknowns"][name]["value"].as_f64().unwrap());
    let mut table = unknowns.join(",") + "\n";
    let mut requests = String::new();
    for at in 0..5 {
        let factor = 1.0 + 0.01 * f64::from(at);
        let row = values.map(|value| (factor * value).to_string());
        table += &(row.join(",") + "\n");
        let genes: BTreeMap<&str, f64> =
            (unknowns.into_iter().zip(values.map(|value| factor * value))).collect();
        requests += &(json!({"id": at, "genes": genes}).to_string() + "\n");
    }
    fs::write(site.path("individuals.csv"), table).unwrap();
    fs::write(site.path("requests"), requests).unwrap();
}

/// Checks that a full disk, a worker of another build and a certificate of the future are told in one line each,
/// and that the run goes on with the remaining host.
#[test]
fn hosts_that_cannot_take_part_are_named_and_the_run_goes_on() {
    let Some(spare) = Spare::start(true) else {
        return;
    };
    let keys = spare.site.path("keys");
    let authority = Authority::open(&keys).unwrap();
    for number in 2..=4 {
        authority
            .issue_worker(&format!("worker-0{number}"), Validity::days(1))
            .unwrap();
    }
    let from = SystemTime::now() + DAY;
    fs::remove_dir_all(keys.join("worker-02")).unwrap();
    let future = Validity {
        from,
        until: from + DAY,
    };
    authority.issue_worker("worker-02", future).unwrap();
    // on the third host, the program is replaced by one that does not know the case's kind of model
    let prologue = spare.site.path("prologue");
    let script = format!(
        "if [ \"$(hostname)\" = node2203 ]; then\n  for worker in ~/.cache/horsehead/worker-*; do\n    \
         if [ -f \"$worker\" ]; then cp -f {} \"$worker\"; fi\n  done\nfi\n",
        worker_program().display()
    );
    fs::write(&prologue, script).unwrap();
    let all = hosts(&HOSTS);
    let calibrate = [
        "calibrate",
        "case",
        "--preset",
        "random",
        "--set",
        "points=4000",
    ];
    let alone = spare.json(&[&calibrate[..], &["--workers", "2", "--run", "alone"]].concat());
    let listen = format!("quic/{HEAD}:7447");
    let words = "--workers 0 --slots 1 --run spare --tls keys --output json --listen LISTEN --ssh HOSTS \
                 --prologue prologue";
    let remote: Vec<&str> = words
        .split_whitespace()
        .map(|word| match word {
            "LISTEN" => listen.as_str(),
            "HOSTS" => all.as_str(),
            word => word,
        })
        .collect();
    let output = spare.run(&[&calibrate[..], &remote].concat());
    let said = errors(&output);
    assert!(output.status.success(), "{said}");
    let object: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(object["log_digest"], alone["log_digest"]);
    for (port, parts) in [
        (2202, ["valid only from", "worker-02"]),
        (2203, ["refused", "oscillator"]),
        (2204, ["No space left", "make room"]),
    ] {
        let place = format!("error: root@{NODE}:{port}: ");
        let lines: Vec<&str> = said.lines().filter(|line| line.contains(&place)).collect();
        assert_eq!(lines.len(), 1, "{port}: {said}");
        assert!(
            parts.iter().all(|part| lines[0].contains(part)),
            "{}",
            lines[0]
        );
    }
}
