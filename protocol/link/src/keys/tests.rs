use super::{
    authority::{Authority, Validity},
    *,
};
use std::{
    collections::BTreeSet,
    fs,
    os::unix::fs::PermissionsExt,
    sync::atomic::{AtomicUsize, Ordering},
    thread,
    time::{Duration, SystemTime},
};

fn made() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let authority = Authority::create(folder.path()).unwrap();
    let hosts = ["head.example".to_owned(), "127.0.0.1".to_owned()];
    authority
        .issue_coordinator(&hosts, Validity::days(10))
        .unwrap();
    authority
        .issue_worker("worker-01", Validity::days(10))
        .unwrap();
    folder
}

#[test]
fn what_was_made_can_be_used_and_only_its_owner_reads_the_keys() {
    let folder = made();
    let at = folder.path();
    // an authority is opened again to let another worker join
    Authority::open(at)
        .unwrap()
        .issue_worker("late", Validity::days(10))
        .unwrap();
    let coordinator = Keys::read(at, KeyRole::Coordinator).unwrap();
    let names: Vec<&str> = coordinator.workers().iter().map(String::as_str).collect();
    assert_eq!(names, ["late", "worker-01"]);
    for name in ["worker-01", "late"] {
        let worker = Keys::read(&at.join(name), KeyRole::Worker).unwrap();
        assert_eq!(worker.owner(), name);
        for secret in [worker.key(), coordinator.key(), at.join(CA_KEY)] {
            let mode = fs::metadata(&secret).unwrap().permissions().mode();
            assert_eq!(mode & 0o777, 0o600, "{}", secret.display());
        }
    }
}

/// Checks that no name is lost when several processes add workers, and that a coordinator that reads the list
/// meanwhile never misses a name. Regression: of eight names added at once one survived, and workers of a run were
/// thrown out.
#[test]
fn names_added_at_once_are_all_on_the_list_and_none_is_ever_missing() {
    let folder = made();
    let at = folder.path();
    let reader = Keys::read(at, KeyRole::Coordinator).unwrap();
    let adding = AtomicUsize::new(8);
    let (read, names) = thread::scope(|scope| {
        for number in 0..8 {
            let adding = &adding;
            scope.spawn(move || {
                let authority = Authority::open(at).unwrap();
                for more in 0..5 {
                    let name = format!("node-{number}-{more}");
                    authority.issue_worker(&name, Validity::days(10)).unwrap();
                }
                adding.fetch_sub(1, Ordering::Relaxed);
            });
        }
        let (mut read, mut names) = (0, BTreeSet::new());
        while adding.load(Ordering::Relaxed) > 0 {
            let now = reader.workers_now().unwrap();
            assert!(now.is_superset(&names), "{names:?}, now {now:?}");
            (read, names) = (read + 1, now);
        }
        (read, reader.workers_now().unwrap())
    });
    assert_eq!(names.len(), 41, "{names:?}");
    assert!(read > 10, "the list was read {read} times");
}

fn refusal(folder: &Path, role: KeyRole) -> String {
    Keys::read(folder, role).unwrap_err().to_string()
}

#[test]
fn every_wrong_file_is_named_with_what_is_wrong() {
    let folder = made();
    let worker = folder.path().join("worker-01");
    let says = |found: &str, expected: &[&str]| {
        for words in expected {
            assert!(found.contains(words), "{found}");
        }
    };
    says(
        &refusal(&worker.join("x"), KeyRole::Worker),
        &["there is no folder", "worker-01/x", "keys new"],
    );
    says(
        &refusal(folder.path(), KeyRole::Worker),
        &[
            "worker.pem is missing",
            "coordinator's folder",
            "/worker-01",
        ],
    );
    says(
        &refusal(&worker, KeyRole::Coordinator),
        &["coordinator.pem is missing", "is a worker's folder"],
    );
    let other = made();
    fs::copy(other.path().join(CA), worker.join(CA)).unwrap();
    says(
        &refusal(&worker, KeyRole::Worker),
        &["worker.pem was not signed by the authority of", "ca.pem"],
    );
    fs::copy(
        other.path().join("worker-01/worker.key"),
        worker.join("worker.key"),
    )
    .unwrap();
    says(
        &refusal(&worker, KeyRole::Worker),
        &["the key beside", "worker.pem is not the one"],
    );
    fs::write(worker.join("worker.key"), "nothing").unwrap();
    says(
        &refusal(&worker, KeyRole::Worker),
        &["worker.key holds no private key in PEM"],
    );
    fs::remove_file(worker.join("worker.key")).unwrap();
    fs::create_dir(worker.join("worker.key")).unwrap();
    says(
        &refusal(&worker, KeyRole::Worker),
        &["worker.key cannot be read: Is a directory"],
    );
    fs::write(folder.path().join(WORKERS), "worker-01\nanyone\n").unwrap();
    says(
        &refusal(folder.path(), KeyRole::Coordinator),
        &["workers", "\"anyone\" cannot name a worker"],
    );
}

#[test]
fn dates_and_purposes_are_checked_before_anyone_is_dialled() {
    let folder = made();
    let authority = Authority::open(folder.path()).unwrap();
    let now = SystemTime::now();
    let day = Duration::from_hours(24);
    let past = Validity {
        from: now - 3 * day,
        until: now - day,
    };
    let future = Validity {
        from: now + day,
        until: now + 3 * day,
    };
    for (name, valid, words) in [
        ("old", past, "is out of date since"),
        ("early", future, "is valid only from"),
    ] {
        let worker = authority.issue_worker(name, valid).unwrap();
        let refused = refusal(&worker, KeyRole::Worker);
        assert!(
            refused.contains(words) && refused.contains("worker.pem"),
            "{refused}"
        );
    }
    // a worker's pair in the coordinator's place: made for dialling, and for no host
    let at = folder.path();
    fs::copy(at.join("worker-01/worker.pem"), at.join(COORDINATOR[0])).unwrap();
    fs::copy(at.join("worker-01/worker.key"), at.join(COORDINATOR[1])).unwrap();
    let refused = refusal(at, KeyRole::Coordinator);
    assert!(
        refused.contains("coordinator.pem cannot be used here"),
        "{refused}"
    );
}

#[test]
fn nothing_is_overwritten() {
    let folder = made();
    let again = Authority::create(folder.path()).unwrap_err().to_string();
    assert!(
        again.contains("is not empty; nothing was written"),
        "{again}"
    );
    let authority = Authority::open(folder.path()).unwrap();
    let twice = authority.issue_worker("worker-01", Validity::days(1));
    assert!(twice.unwrap_err().to_string().contains("exists already"));
    let bad = authority.issue_worker("../up", Validity::days(1));
    assert!(
        bad.unwrap_err()
            .to_string()
            .contains("cannot name a worker")
    );
}
