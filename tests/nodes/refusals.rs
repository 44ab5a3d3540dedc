//! Tests of hosts on which no worker can be started: each gives one line with the host, the failed step and
//! the remedy.
use super::*;

#[test]
fn every_host_that_fails_is_named_with_its_step_and_its_remedy() {
    let site = Site::new(9);
    let wanted = [
        (
            "unknown",
            "cannot see whether a worker can run there",
            "log in once with",
        ),
        (
            "changed",
            "cannot see whether a worker can run there",
            "ssh-keygen -R",
        ),
        (
            "locked",
            "cannot see whether a worker can run there",
            "ssh-copy-id",
        ),
        (
            "nowhere",
            "cannot see whether a worker can run there",
            "~/.ssh/config",
        ),
        (
            "old",
            "it has glibc 2.17, and the worker needs 2.",
            "deploy/portable.sh",
        ),
        (
            "other",
            "the host runs \"Linux mips\"",
            "--worker-program ARCH=PATH",
        ),
    ];
    let hosts: Vec<&str> = wanted.iter().map(|(host, ..)| *host).collect();
    let failed = site.up(&["--ssh", &hosts.join(","), "--wait", "0"]);
    assert_eq!(failed.status.code(), Some(1));
    let said = errors(&failed);
    for (host, step, remedy) in wanted {
        let of_host = format!("error: {host}: ");
        let mut lines = said.lines().filter(|line| line.starts_with(&of_host));
        let line = lines
            .next()
            .unwrap_or_else(|| panic!("nothing of {host}: {said}"));
        assert!(line.contains(step) && line.contains(remedy), "{line}");
        assert_eq!(lines.next(), None, "one line of {host}");
    }
    assert!(said.contains("6 of 6 places failed"), "{said}");
}

#[test]
fn a_disk_that_is_full_leaves_no_half_of_a_program() {
    if !rustix::process::geteuid().is_root() {
        tests::skip("a full disk needs root");
        return;
    }
    let site = Site::new(1);
    let failed = site.up(&["--ssh", "full", "--wait", "0"]);
    let said = errors(&failed);
    let words = [
        "full: cannot copy the worker there",
        "No space left",
        "make room",
    ];
    assert!(words.iter().all(|words| said.contains(words)), "{said}");
}

#[test]
fn a_worker_whose_coordinator_does_not_answer_is_started_and_said_to_be_alone() {
    let site = Site::new(1);
    let alone = site.up(&["--ssh", "a", "--wait", "4"]);
    let said = errors(&alone);
    assert_eq!(alone.status.code(), Some(1), "{said}");
    let words = [
        "a: cannot see that it takes part in a run",
        "nobody answers at",
        "workers logs",
    ];
    assert!(words.iter().all(|words| said.contains(words)), "{said}");
    assert!(runs(&site.process("a", "worker-01")));
}

#[test]
fn what_cannot_be_planned_is_refused_before_anything_is_done() {
    let site = Site::new(1);
    let worker = tests::process::worker_program();
    let foreign = format!("mips={}", worker.display());
    for (words, wanted) in [
        (vec!["--ssh", "a,a"], "a is named twice"),
        (vec!["--ssh=-oProxyCommand=x"], "is not a valid host"),
        (vec!["--hosts", "none.txt"], "none.txt: No such file"),
        (
            vec!["--slurm", "nodes"],
            "--slurm nodes: \"nodes\" is not understood",
        ),
        (
            vec!["--k8s", "copies=2"],
            "write KEY=VALUE with one of replicas",
        ),
        (
            vec!["--systemd", "slots=0"],
            "--systemd slots=0: not a number of slots",
        ),
        (
            vec!["--ssh", "a", "--worker-program", &foreign],
            "it is a program for",
        ),
    ] {
        let refused = site.up(&words);
        assert_eq!(
            refused.status.code(),
            Some(2),
            "{words:?}: {}",
            errors(&refused)
        );
        assert!(
            errors(&refused).contains(wanted),
            "{words:?}: {}",
            errors(&refused)
        );
    }
    assert!(!site.path("homes").exists(), "a host was asked");
}
