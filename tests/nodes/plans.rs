//! Tests of launch plans as printed by `--dry-run`: they are complete, made without contacting a host, and
//! accepted by linters where these are installed.
use super::*;
use launch::Program;
use std::process::Stdio;

/// Returns all files of a folder, recursively, with their contents.
fn contents(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut all = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(contents(&path));
        } else {
            let content = fs::read(&path).unwrap();
            all.push((path, content));
        }
    }
    all.sort();
    all
}

/// Returns the plan that `workers up --dry-run` prints with an empty `PATH`.
fn printed(site: &Site, words: &[&str]) -> String {
    let common = [
        "workers",
        "up",
        "--connect",
        &site.locator,
        "--tls",
        "keys",
        "--dry-run",
    ];
    let mut command = site.command(&[&common, words].concat());
    let output = command
        .env("PATH", "")
        .env("HOME", site.folder.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", errors(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// Returns the here-document that follows the first `from` in a script.
fn read_by<'a>(script: &'a str, from: &str) -> &'a str {
    let (_, text) = script.split_once(from).unwrap();
    text.split("HORSEHEAD_END\n").next().unwrap()
}

/// Runs a linter on a file and asserts success; skips the check where the linter is not installed.
fn checked(program: &str, words: &[&str], file: &Path) {
    let file = std::path::absolute(file).unwrap();
    let words = [words, &[file.to_str().unwrap()]].concat();
    printed_in(file.parent().unwrap(), program, &words);
}

/// Runs a checker in a folder and returns what it prints; `None` after [`tests::skip`] where it is missing.
fn printed_in(folder: &Path, program: &str, words: &[&str]) -> Option<String> {
    let output = Command::new(program)
        .args(words)
        .current_dir(folder)
        // what systemd-analyze looks into, though nothing of it matters here
        .env("XDG_RUNTIME_DIR", std::env::temp_dir())
        .stdin(Stdio::null())
        .output();
    let Ok(output) = output else {
        tests::skip(&format!("{program} is not installed"));
        return None;
    };
    let printed = String::from_utf8_lossy(&output.stdout).into_owned();
    let said = errors(&output);
    assert!(
        output.status.success(),
        "{program} {words:?}: {printed}{said}"
    );
    Some(printed)
}

/// Asserts that a text contains every one of `parts`.
fn contains_all(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn plans_are_printed_without_anybody_in_reach_and_nothing_is_written() {
    let site = Site::new(1);
    let prologue = site.path("prologue");
    fs::write(&prologue, "module load gcc\n").unwrap();
    let hosts = site.path("hosts");
    fs::write(&hosts, "# spare ones\nme@one:2222 slots=3\ntwo\n").unwrap();
    let before = contents(site.folder.path());
    let prologue = prologue.to_str().unwrap();
    let ssh = printed(
        &site,
        &["--hosts", hosts.to_str().unwrap(), "--prologue", prologue],
    );
    let slurm = printed(
        &site,
        &[
            "--slurm",
            "nodes=4,time=02:00:00",
            "--sbatch-arg=--account=x y",
            "--prologue",
            prologue,
        ],
    );
    let k8s = printed(&site, &["--k8s", "replicas=3,namespace=spare,cpu=2"]);
    let systemd = printed(&site, &["--systemd", "slots=2"]);
    assert_eq!(
        contents(site.folder.path()),
        before,
        "something was written"
    );
    let key = fs::read_to_string(site.path("keys/worker-01/worker.key")).unwrap();
    let secret = key.lines().nth(1).unwrap();
    for plan in [&ssh, &slurm, &k8s, &systemd] {
        assert!(
            !plan.contains(secret) && !plan.contains("PRIVATE KEY"),
            "{plan}"
        );
        let file = site.path("plan.sh");
        fs::write(&file, plan).unwrap();
        checked("sh", &["-n"], &file);
        checked("shellcheck", &[], &file);
    }

    contains_all(&ssh, &["-p 2222 me@one", "--slots 3", "module load gcc"]);
    let batch = site.path("batch.sh");
    let submission = "sbatch --nodes=4 --time=02:00:00 '--account=x y'";
    contains_all(&slurm, &[submission]);
    fs::write(&batch, read_by(&slurm, " <<'HORSEHEAD_END'\n")).unwrap();
    checked("shellcheck", &[], &batch);
    let batch = fs::read_to_string(&batch).unwrap();
    let locator = format!("export HORSEHEAD_CONNECT={}\n", site.locator);
    let exported = [&locator, "export HORSEHEAD_TLS=", "--idle-timeout 3600\n"];
    contains_all(&batch, &exported);
    let (before_checks, _) = batch.split_once("set -euo pipefail").unwrap();
    assert!(before_checks.contains("module load gcc"), "{batch}");
    let unit = site.path("horsehead-worker.service");
    fs::write(&unit, read_by(&systemd, " <<'HORSEHEAD_END'\n")).unwrap();
    checked("systemd-analyze", &["verify", "--user"], &unit);
    let manifests = site.path("manifests.yaml");
    fs::write(&manifests, read_by(&k8s, "-f - <<'HORSEHEAD_END'\n")).unwrap();
    checked("kubernetes-validate", &["--strict"], &manifests);
    let manifests = fs::read_to_string(&manifests).unwrap();
    let port = site.locator.rsplit(':').next().unwrap();
    let parts = [
        "replicas: 3",
        r#""cpu":"2""#,
        "/keys",
        r#"cidr":"127.0.0.1/32""#,
        &format!("port: {port}"),
        &format!(r#""--connect","{}""#, site.locator),
    ];
    contains_all(&manifests, &parts);
    assert!(!manifests.contains("envFrom"), "{manifests}");
}

/// Checks that running a printed plan starts the same worker as the launch itself.
#[test]
fn a_printed_plan_does_what_a_launch_does() {
    let site = Site::new(1);
    let plan = site.path("plan.sh");
    fs::write(
        &plan,
        site.up(&["--ssh", "a", "--wait", "0", "--dry-run"]).stdout,
    )
    .unwrap();
    let done = site.program("sh").arg(&plan).output().unwrap();
    assert!(done.status.success(), "{}", errors(&done));
    let process = site.process("a", "worker-01");
    assert!(runs(&process));
    // the launch finds everything as it wants it
    let again = site.up(&["--ssh", "a", "--wait", "0"]);
    assert!(again.status.success(), "{}", errors(&again));
    assert_eq!(site.process("a", "worker-01"), process);
}

/// Checks the scripts and manifests in `deploy/`, which are meant for launching by hand, with linters.
#[test]
fn the_files_of_deploy_pass_those_who_check_such_things() {
    let deploy = Path::new(env!("CARGO_MANIFEST_DIR")).join("../deploy");
    for script in [
        "portable.sh",
        "slurm/workers.sbatch",
        "slurm/rehearse.sh",
        "pbs/workers.pbs",
    ] {
        checked("bash", &["-n"], &deploy.join(script));
        checked("shellcheck", &[], &deploy.join(script));
    }
    for manifest in ["deployment", "job", "network-policy"] {
        let file = deploy.join(format!("k8s/{manifest}.yaml"));
        checked("kubernetes-validate", &["--strict"], &file);
    }
    checked("hadolint", &[], &deploy.join("Containerfile"));
    let compose = ["--project-directory", "..", "--file", "compose.yaml"];
    printed_in(
        &deploy,
        "docker-compose",
        &[&compose[..], &["config"]].concat(),
    );

    // what kustomize makes of the folder, with a worker's keys beside the manifests
    let scratch = tempfile::tempdir().unwrap();
    let folder = scratch.path().join("k8s");
    fs::create_dir_all(folder.join("keys")).unwrap();
    for file in fs::read_dir(deploy.join("k8s")).unwrap() {
        let file = file.unwrap();
        fs::copy(file.path(), folder.join(file.file_name())).unwrap();
    }
    for file in ["ca.pem", "worker.pem", "worker.key"] {
        fs::write(folder.join("keys").join(file), "key material").unwrap();
    }
    if let Some(made) = printed_in(&folder, "kubectl", &["kustomize", "."]) {
        for part in [
            "kind: Secret",
            "kind: ConfigMap",
            "kind: NetworkPolicy",
            "replicas: 4",
        ] {
            assert!(made.contains(part), "{part}: {made}");
        }
        let manifests = scratch.path().join("made.yaml");
        fs::write(&manifests, made).unwrap();
        checked("kubernetes-validate", &["--strict"], &manifests);
    }

    // a unit names a program that must be there
    for (name, program, own) in [
        (
            "horsehead-worker",
            "horsehead-worker",
            tests::process::worker_program(),
        ),
        ("horsehead-coordinator", "horsehead", coordinator_program()),
    ] {
        let unit = scratch.path().join(format!("{name}.service"));
        let text = fs::read_to_string(deploy.join(format!("systemd/{name}.service"))).unwrap();
        let installed = format!("ExecStart=/usr/local/bin/{program}");
        let text = text.replace(&installed, &format!("ExecStart={}", own.display()));
        fs::write(&unit, text).unwrap();
        checked("systemd-analyze", &["verify", "--man=no"], &unit);
    }
}

/// Checks that the files of a coordinator that its unit names are a folder of key material that it can use.
#[test]
fn the_credentials_of_the_unit_are_those_that_a_coordinator_needs() {
    let site = Site::new(1);
    let unit = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../deploy/systemd/horsehead-coordinator.service");
    let text = fs::read_to_string(unit).unwrap();
    fs::create_dir(site.path("credentials")).unwrap();
    let named = text.lines().filter_map(|line| {
        let (name, path) = line.strip_prefix("LoadCredential=")?.split_once(':')?;
        Some((name, path.strip_prefix("/etc/horsehead/")?))
    });
    for (name, path) in named {
        fs::copy(site.path(path), site.path("credentials").join(name)).unwrap();
    }
    let checked = site.horsehead(&["keys", "check", "credentials"]);
    let said = String::from_utf8_lossy(&checked.stdout).into_owned() + &errors(&checked);
    assert!(checked.status.success(), "{said}");
    assert!(said.contains("coordinator; 1 workers may join"), "{said}");
}

/// Checks that workers built by `deploy/portable.sh` need no newer glibc than 2.28, if the script has been
/// run.
#[test]
fn a_portable_worker_needs_no_newer_library_than_it_says() {
    let made = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/portable");
    let machines = ["x86_64", "aarch64"].map(|machine| (machine, made.join(machine)));
    let mut found = 0;
    for (machine, folder) in machines.into_iter().filter(|(_, folder)| folder.exists()) {
        let program = Program::read(&folder.join("horsehead-worker")).unwrap();
        assert_eq!(program.machine, machine);
        assert!(program.glibc <= vec![2, 28], "{program:?}");
        found += 1;
    }
    if found == 0 {
        // minutes of building that nothing else needs: the one check that may be passed over anywhere
        eprintln!("skipped: deploy/portable.sh has not been run");
    }
}
