//! A journal under torture.
use super::*;
use protocol::{
    event::{Event, Finished},
    id::{AttemptId, ContentHash, JobId, RunId},
    job::Outcome,
    message::Attempt,
};
use std::{
    collections::BTreeMap,
    fs,
    path::Path,
    sync::{Arc, Mutex},
};

fn header() -> RunHeader {
    RunHeader {
        kind: "calibrate".to_owned(),
        case: ContentHash::of(b"case"),
        settings: r#"{"preset":"quick","seed":3}"#.to_owned(),
    }
}

fn result(job: u64) -> Event {
    Event::Finished(Box::new(Finished {
        attempt: Attempt {
            job: JobId(job),
            attempt: AttemptId(7),
        },
        work: ContentHash::of(&job.to_le_bytes()),
        worker: None,
        wall_us: 11 * job,
        outcome: Outcome::Nothing(job.to_le_bytes().repeat(3)),
    }))
}

fn open(folder: &Path) -> Result<(Journal, Begun), JournalError> {
    Journal::open(folder, &header(), RunId(5), 17, |_| {})
}

/// A closed journal with results 1 to `jobs`.
fn written(folder: &Path, jobs: u64) -> Vec<u8> {
    let (journal, _) = open(folder).unwrap();
    for job in 1..=jobs {
        journal.append(result(job)).unwrap();
    }
    drop(journal);
    fs::read(folder.join(FILE)).unwrap()
}

/// Results by job, the run's name, and the damage.
fn read(path: &Path) -> (BTreeMap<u64, Event>, Option<RunId>, Vec<Damage>) {
    let (mut results, mut begun) = (BTreeMap::new(), None);
    let report = fold(path, |_, event| match event {
        Event::Begun { run, .. } => begun = Some(run),
        Event::Finished(finished) => {
            results.insert(finished.job().0, Event::Finished(finished));
        }
        Event::Opened { .. } | Event::Joined { .. } | Event::Left { .. } | Event::Closed => {}
    });
    (results, begun, report.unwrap().damage)
}

fn expect_true(results: &BTreeMap<u64, Event>) {
    for (job, event) in results {
        assert_eq!(*event, result(*job));
    }
}

#[test]
fn what_was_stored_is_recalled_by_the_next_process() {
    let folder = tempfile::tempdir().unwrap();
    let stored = Arc::new(Mutex::new(Vec::new()));
    let seen = Arc::clone(&stored);
    let (journal, begun) = Journal::open(folder.path(), &header(), RunId(5), 1, move |said| {
        if let Appended::Stored(jobs) = said {
            seen.lock().unwrap().extend(jobs);
        }
    })
    .unwrap();
    assert_eq!((begun.run, begun.epoch), (RunId(5), 1));
    for job in 1..=40 {
        journal.append(result(job)).unwrap();
    }
    drop(journal);
    assert_eq!(
        *stored.lock().unwrap(),
        (1..=40).map(JobId).collect::<Vec<_>>()
    );

    let (journal, begun) = Journal::open(folder.path(), &header(), RunId(99), 2, |_| {}).unwrap();
    assert_eq!(
        (begun.run, begun.epoch),
        (RunId(5), 2),
        "the run keeps its name"
    );
    assert_eq!(journal.finished().count(), 40);
    for job in 1..=40 {
        let finished = journal.recall(JobId(job)).unwrap().unwrap();
        assert_eq!(Event::Finished(Box::new(finished)), result(job));
    }
    assert_eq!(journal.recall(JobId(41)).unwrap(), None);
}

#[test]
fn two_coordinators_cannot_write_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let first = open(folder.path()).unwrap();
    assert!(matches!(
        open(folder.path()),
        Err(JournalError::Locked { .. })
    ));
    drop(first);
    drop(open(folder.path()).unwrap());
}

#[test]
fn another_run_is_refused_and_the_difference_named() {
    let folder = tempfile::tempdir().unwrap();
    drop(open(folder.path()).unwrap());
    let other = RunHeader {
        settings: r#"{"preset":"quick","seed":4,"trials":2}"#.to_owned(),
        case: ContentHash::of(b"other"),
        ..header()
    };
    let error = Journal::open(folder.path(), &other, RunId(1), 1, |_| {})
        .unwrap_err()
        .to_string();
    for part in [
        "case (content ",
        "seed (3, now 4)",
        "trials (none, now 2)",
        "another run folder",
    ] {
        assert!(error.contains(part), "{part}: {error}");
    }
    assert!(!error.contains("preset"), "{error}");
}

/// However much of the tail is missing, what is whole remains, and the run goes on.
#[test]
fn every_truncation_loses_only_the_cut_records() {
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 4);
    let path = folder.path().join(FILE);
    let mut kept = 4;
    for length in (0..=whole.len()).rev() {
        fs::write(&path, &whole[..length]).unwrap();
        let (results, begun, damage) = read(&path);
        expect_true(&results);
        assert!(
            results.len() <= kept && kept - results.len() <= 1,
            "{length}"
        );
        assert_eq!(
            results.len() as u64,
            results.keys().max().copied().unwrap_or(0),
            "{length}"
        );
        kept = results.len();
        assert!(
            damage.iter().all(|damage| damage.torn) && damage.len() <= 1,
            "{length}"
        );
        // the next process goes on from there and leaves a sound journal behind
        let (journal, _) = open(folder.path()).unwrap();
        journal.append(result(9)).unwrap();
        drop(journal);
        let (results, _, damage) = read(&path);
        assert_eq!(
            (results.len(), damage.len()),
            (kept + 1, 0),
            "{length} {begun:?}"
        );
    }
    assert_eq!(kept, 0);
}

/// A flipped byte costs one record; the one before and the one behind it stay.
#[test]
fn every_flipped_byte_loses_one_record() {
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 5);
    let path = folder.path().join(FILE);
    for at in 0..whole.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut bytes = whole.clone();
            bytes[at] ^= flip;
            fs::write(&path, &bytes).unwrap();
            let (results, begun, damage) = read(&path);
            expect_true(&results);
            let lost = 5 - results.len() + usize::from(begun.is_none());
            assert!(lost <= 1, "{lost} lost by byte {at}");
            assert_eq!(damage.len(), 1, "byte {at}");
        }
    }
}

/// A block of zeros, as a file system leaves it after a crash, costs the records under it.
#[test]
fn a_zeroed_block_loses_only_what_it_covers() {
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 400);
    let path = folder.path().join(FILE);
    let record = record_length();
    let from = whole.len() / 2;
    let mut bytes = whole;
    bytes[from..from + 8192].fill(0);
    fs::write(&path, &bytes).unwrap();
    let (results, begun, damage) = read(&path);
    expect_true(&results);
    assert_eq!(begun, Some(RunId(5)));
    let lost = 400 - results.len();
    assert!(
        (8192 / record..=8192 / record + 2).contains(&lost),
        "{lost} lost"
    );
    assert_eq!(damage.len(), 1);
    assert!(damage[0].to_string().contains("skipped"));
    let (journal, begun) = open(folder.path()).unwrap();
    assert_eq!(
        (journal.finished().count(), begun.report.damage.len()),
        (results.len(), 1)
    );
}

fn record_length() -> usize {
    protocol::wire::encode(&result(1)).unwrap().len() + RECORD_HEADER
}

#[test]
fn a_journal_without_its_first_record_is_not_continued() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = written(folder.path(), 2);
    bytes[6] ^= 0xff;
    fs::write(folder.path().join(FILE), bytes).unwrap();
    assert!(matches!(
        open(folder.path()),
        Err(JournalError::Headless { .. })
    ));
}

#[test]
fn a_seed_and_settings_that_differ_are_named_not_dumped() {
    let header = |settings: &str| RunHeader {
        settings: settings.to_owned(),
        ..header()
    };
    let was = header(r#"[1,{"name":"quick","stages":[{"size":24},{"size":8,"x":null}]}]"#);
    let seed = header(r#"[2,{"name":"quick","stages":[{"size":24},{"size":8,"x":null}]}]"#);
    assert_eq!(differences(&was, &seed), ["seed (1, now 2)"]);
    let size = header(r#"[1,{"name":"quick","stages":[{"size":24},{"size":9,"x":null}]}]"#);
    assert_eq!(differences(&was, &size), ["stages.2.size (8, now 9)"]);
    let other = header(r#"[1,{"a":1,"b":2,"c":3,"d":4}]"#);
    assert_eq!(differences(&was, &other).len(), 4);
}
