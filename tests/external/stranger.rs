//! Tests of what another user of the machine can do to the runs of programs.
use super::rig::Rig;
use std::{
    fs,
    os::unix::fs::PermissionsExt,
    process::Command,
    time::{Duration, Instant},
};
use tests::{
    process::{Process, wait_until},
    stranger::as_stranger,
};

const LIMIT: Duration = Duration::from_secs(20);

/// Checks that a stranger who can write to the folder of temporary files neither has files deleted nor stops runs.
/// Regression: what a symbolic link of his led to was deleted, and a lock that he held stopped every run.
#[test]
fn a_stranger_has_no_file_deleted_and_stops_no_run() {
    let rig = Rig::shell("echo 'time,y\n0,1\n1,2\n2,4' > out.csv\n", "");
    let (shared, victim) = (rig.file(""), rig.file("victim"));
    fs::create_dir(&victim).unwrap();
    for name in ["precious", "lock"] {
        fs::write(victim.join(name), "").unwrap();
    }
    let mut touch = Command::new("touch");
    let aged = touch.args(["-d", "1 hour ago"]).arg(&victim).status();
    assert!(aged.unwrap().success());
    fs::set_permissions(&shared, fs::Permissions::from_mode(0o1777)).unwrap();
    let uid = rustix::process::geteuid().as_raw();
    let script = format!(
        "cd {}; ln -s {} horsehead-7-0; mkdir -m 777 horsehead-{uid}; ln -s {1} horsehead-{uid}/run-7-0; \
         for name in horsehead-shell.0.lock horsehead-{uid}/shell.0.lock; do touch $name; chmod 666 $name; done; \
         exec flock -F horsehead-shell.0.lock flock -F horsehead-{uid}/shell.0.lock sh -c 'touch held; exec sleep 600'",
        shared.display(),
        victim.display()
    );
    let Some(mut stranger) = as_stranger("sh") else {
        return;
    };
    stranger.args(["-c", &script]);
    let held = rig.file("held");
    let stranger = Process::start(stranger);
    wait_until("the stranger holds the locks", LIMIT, || held.exists());
    rig.limit("[entry.shell]\n", "[entry.shell]\nat_once = 1\n");
    let begun = Instant::now();
    let run = Process::start(rig.command(&["simulate", "case"]));
    let mut run = run;
    assert_eq!(run.wait(LIMIT), Some(0), "after {:?}", begun.elapsed());
    assert!(victim.join("precious").exists() && victim.join("lock").exists());
    drop(stranger);
}
