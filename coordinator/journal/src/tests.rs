//! Tests of the journal under truncation, flipped bytes, zeroed blocks and deletion.
use super::{
    differences::differences,
    record::{RECORD_HEADER, checksum, record},
    sample::{finished, result},
    *,
};
use crate::event::{Event, RunHeader};
use protocol::{
    id::{ContentHash, JobId, RunId},
    job::{Failure, Outcome},
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

fn open(folder: &Path) -> Result<(Journal, OpenedRun), JournalError> {
    Journal::open(folder, &header(), RunId(5), 17, |_| {})
}

/// Writes a journal with the results of jobs 1 to `jobs` and closes it; returns the file's bytes.
fn written(folder: &Path, jobs: u64) -> Vec<u8> {
    let (journal, _) = open(folder).unwrap();
    for job in 1..=jobs {
        journal.append(result(job)).unwrap();
    }
    drop(journal);
    fs::read(folder.join(FILE)).unwrap()
}

/// Reads a journal's results by job, the run's identifier, and the damage found.
fn read(path: &Path) -> (BTreeMap<u64, Event>, Option<RunId>, Vec<Damage>) {
    let (mut results, mut begun) = (BTreeMap::new(), None);
    let report = fold(path, |_, event| match event {
        Event::Begun { run, .. } => begun = Some(run),
        Event::Finished(finished) => {
            results.insert(finished.job().0, Event::Finished(finished));
        }
        Event::Opened { .. }
        | Event::Joined { .. }
        | Event::Left { .. }
        | Event::Closed
        | Event::Asked(_)
        | Event::Found { .. }
        | Event::Proved { .. }
        | Event::Accounted(_) => {}
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
        if let WriterReport::Stored(jobs) = said {
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

/// Checks that every truncation loses only the records it cuts, and that the run continues.
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

/// Asserts that the next process continues a damaged journal: it keeps the run's identifier and every
/// readable result, computes the others again, and never reuses an attempt identifier. Returns the number of
/// results kept.
fn goes_on(folder: &Path, bytes: &[u8], jobs: u64, what: &str) -> usize {
    fs::write(folder.join(FILE), bytes).unwrap();
    let (results, _, _) = read(&folder.join(FILE));
    expect_true(&results);
    let (journal, begun) = open(folder).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert_eq!(begun.run, RunId(5), "{what}");
    assert!(begun.epoch >= 2, "{what}: epoch {}", begun.epoch);
    assert_eq!(journal.finished().count(), results.len(), "{what}");
    for job in (1..=jobs).filter(|job| !results.contains_key(job)) {
        assert_eq!(journal.recall(JobId(job)).unwrap(), None, "{what}");
        journal.append(result(job)).unwrap();
    }
    drop(journal);
    let (all, _, _) = read(&folder.join(FILE));
    expect_true(&all);
    assert_eq!(all.len() as u64, jobs, "{what}");
    results.len()
}

/// Checks that a flipped byte costs one record, that the records before and after it stay, and that the run
/// continues.
#[test]
fn every_flipped_byte_loses_one_record_and_the_run_goes_on() {
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
        let mut bytes = whole.clone();
        bytes[at] ^= 0xff;
        goes_on(folder.path(), &bytes, 5, &format!("byte {at}"));
    }
}

/// Checks that damage to or loss of the copy of the first record is harmless while the journal has its own
/// first record.
#[test]
fn damage_of_the_copy_does_no_harm() {
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 3);
    let copy = fs::read(folder.path().join(HEAD)).unwrap();
    for at in 0..copy.len() {
        let mut bytes = copy.clone();
        bytes[at] ^= 0xff;
        fs::write(folder.path().join(HEAD), &bytes).unwrap();
        assert_eq!(goes_on(folder.path(), &whole, 3, &format!("copy {at}")), 3);
        assert_eq!(fs::read(folder.path().join(HEAD)).unwrap(), copy, "mended");
    }
    fs::remove_file(folder.path().join(HEAD)).unwrap();
    assert_eq!(goes_on(folder.path(), &whole, 3, "no copy"), 3);
}

/// Checks that a block of zeros, as a file system may leave after a crash, costs only the records it covers,
/// wherever it lies.
#[test]
fn every_zeroed_block_loses_only_what_it_covers() {
    const BLOCK: usize = 8192;
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 400);
    let record = record_length();
    assert!(whole.len() > 5 * BLOCK, "{}", whole.len());
    // aligned as on a disk, and the same moved by odd numbers
    for shift in [0, 1, 511, 4096] {
        for from in (shift..whole.len()).step_by(BLOCK) {
            let to = (from + BLOCK).min(whole.len());
            let mut bytes = whole.clone();
            bytes[from..to].fill(0);
            let kept = goes_on(folder.path(), &bytes, 400, &format!("zeros from {from}"));
            let lost = 400 - kept;
            let most = (to - from).div_ceil(record) + 1;
            assert!(
                lost <= most,
                "{lost} lost by zeros from {from}, {most} touched"
            );
        }
    }
}

/// Checks that a journal overwritten entirely by zeros loses its results, but that the run restarts under its
/// own identifier.
#[test]
fn a_journal_of_zeros_is_begun_anew_under_its_own_name() {
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 3);
    let zeros = vec![0; whole.len()];
    assert_eq!(goes_on(folder.path(), &zeros, 3, "all zeros"), 0);
    let zeros = vec![0; 3 * 8192];
    assert_eq!(goes_on(folder.path(), &zeros, 3, "more zeros"), 0);
}

/// Regression test: a journal of an older version is refused and left unchanged; it was once taken for
/// damaged, and all its results would have been computed again.
#[test]
fn a_journal_of_another_version_is_refused_as_such_and_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = written(folder.path(), 3);
    let of_ours = |bytes: &[u8]| bytes.windows(4).position(|part| part == MARK);
    while let Some(at) = of_ours(&bytes) {
        bytes[at + 3] = b'1';
    }
    let path = folder.path().join(FILE);
    fs::write(&path, &bytes).unwrap();
    let refused = open(folder.path()).unwrap_err().to_string();
    let words = format!("is of version 1, and this build reads version {VERSION}");
    assert!(refused.contains(&words), "{refused}");
    assert!(matches!(
        fold(&path, |_, _| {}),
        Err(JournalError::Version { found: 1, .. })
    ));
    assert_eq!(fs::read(&path).unwrap(), bytes);
}

/// Checks that an intact record that cannot be read, of this version or another one, stops the reading wherever it
/// stands and is left as it is. Regression: it was cut off as torn, with all records after it.
#[test]
fn an_intact_record_that_cannot_be_read_is_never_cut_off() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(FILE);
    let whole = written(folder.path(), 40);
    let body = vec![0xff; 40];
    let length = u32::try_from(body.len()).unwrap();
    let mut strange = MARK.to_vec();
    strange.extend(length.to_le_bytes());
    strange.extend(checksum(length, &body).to_le_bytes());
    strange.extend(&body);
    let mut foreign = record(&result(41)).unwrap();
    foreign[3] += 1;
    let foreign = foreign.repeat(2);
    let torn = [&foreign[..], &whole[..20]].concat();
    let behind_damage = [&[0; 100], &foreign[..]].concat();
    for last in [strange, foreign, torn, behind_damage] {
        let bytes = [&whole[..], &last].concat();
        fs::write(&path, &bytes).unwrap();
        let error = open(folder.path()).unwrap_err();
        assert!(
            matches!(
                error,
                JournalError::Undecodable { .. } | JournalError::Version { .. }
            ),
            "{error}"
        );
        assert_eq!(fs::read(&path).unwrap(), bytes);
    }
    // a single record of another version has a damaged byte: it is not cut off either
    let mut bytes = whole;
    let last = bytes.len() - record_length();
    bytes[last + 3] += 1;
    fs::write(&path, &bytes).unwrap();
    drop(open(folder.path()).unwrap());
    assert!(fs::read(&path).unwrap().starts_with(&bytes));
}

/// Checks that jobs whose workers were lost, which earlier versions recorded as failed, have no result.
#[test]
fn lost_workers_of_an_earlier_version_are_no_results() {
    let folder = tempfile::tempdir().unwrap();
    let (journal, _) = open(folder.path()).unwrap();
    let lost = Outcome::Failed(Failure::Lost { workers: 4 });
    journal.append(finished(1, 5, lost)).unwrap();
    journal.append(result(2)).unwrap();
    drop(journal);
    let (journal, _) = open(folder.path()).unwrap();
    assert_eq!(journal.finished().collect::<Vec<_>>(), [JobId(2)]);
    assert_eq!(journal.recall(JobId(1)).unwrap(), None);
    journal.append(result(1)).unwrap();
    drop(journal);
    assert_eq!(read(&folder.path().join(FILE)).0.len(), 2);
}

/// Checks that the lock lies on the journal itself, so that it cannot be deleted under a run.
#[test]
fn a_run_whose_lock_file_was_deleted_stays_locked() {
    let folder = tempfile::tempdir().unwrap();
    let own = open(folder.path()).unwrap();
    fs::remove_file(folder.path().join(LOCK)).unwrap();
    assert!(matches!(
        open(folder.path()),
        Err(JournalError::Locked { .. })
    ));
    drop(own);
    // coordinators of earlier versions know the other file alone
    let other = fs::File::create(folder.path().join(LOCK)).unwrap();
    other.lock().unwrap();
    assert!(matches!(
        open(folder.path()),
        Err(JournalError::Locked { .. })
    ));
}

#[test]
fn a_run_in_use_is_not_discarded() {
    let folder = tempfile::tempdir().unwrap();
    let own = open(folder.path()).unwrap();
    let error = discard(folder.path()).unwrap_err();
    assert!(matches!(error, JournalError::Locked { .. }), "{error}");
    drop(own);
    discard(folder.path()).unwrap();
    assert!(!folder.path().exists());
}

/// Checks that nothing is acknowledged once another file stands at the journal's path.
#[test]
fn a_journal_that_was_replaced_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(FILE);
    let (say, said) = std::sync::mpsc::channel();
    let (journal, _) = Journal::open(folder.path(), &header(), RunId(5), 17, move |appended| {
        say.send(appended).unwrap();
    })
    .unwrap();
    fs::rename(&path, folder.path().join("moved")).unwrap();
    fs::copy(folder.path().join("moved"), &path).unwrap();
    journal.append(result(1)).unwrap();
    assert_eq!(said.recv(), Ok(WriterReport::Deleted));
}

/// Checks that results written to a deleted journal, which cannot be found again, are not acknowledged.
#[test]
fn nothing_is_acknowledged_that_was_written_to_a_deleted_file() {
    let folder = tempfile::tempdir().unwrap();
    let (say, said) = std::sync::mpsc::channel();
    let (journal, _) = Journal::open(folder.path(), &header(), RunId(5), 17, move |appended| {
        say.send(appended).unwrap();
    })
    .unwrap();
    journal.append(result(1)).unwrap();
    assert_eq!(said.recv(), Ok(WriterReport::Stored(vec![JobId(1)])));
    fs::remove_dir_all(folder.path()).unwrap();
    journal.append(result(2)).unwrap();
    assert_eq!(said.recv(), Ok(WriterReport::Deleted));
    drop(journal);
    assert!(said.recv().is_err(), "nothing else");
}

fn record_length() -> usize {
    protocol::wire::encode(&result(1)).unwrap().len() + RECORD_HEADER
}

/// Checks that a journal without any record identifying its run is not continued: its results might belong to
/// another case.
#[test]
fn a_journal_of_which_nothing_says_what_it_is_is_not_continued() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = written(folder.path(), 2);
    bytes[6] ^= 0xff;
    fs::write(folder.path().join(FILE), bytes).unwrap();
    fs::remove_file(folder.path().join(HEAD)).unwrap();
    assert!(matches!(
        open(folder.path()),
        Err(JournalError::Unidentified { .. })
    ));
}

/// Checks that a copy of another run's first record is ignored beside an empty journal, and refused beside
/// results.
#[test]
fn a_copy_of_another_run_refuses_only_if_there_is_something_to_mix() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = written(folder.path(), 2);
    bytes[6] ^= 0xff;
    let other = RunHeader {
        settings: "{}".to_owned(),
        ..header()
    };
    fs::write(folder.path().join(FILE), &bytes).unwrap();
    assert!(matches!(
        Journal::open(folder.path(), &other, RunId(6), 1, |_| {}),
        Err(JournalError::Differs { .. })
    ));
    fs::write(folder.path().join(FILE), []).unwrap();
    let (_, begun) = Journal::open(folder.path(), &other, RunId(6), 1, |_| {}).unwrap();
    assert_eq!((begun.run, begun.epoch), (RunId(6), 1));
}

#[test]
fn a_seed_and_settings_that_differ_are_named_not_dumped() {
    let header = |settings: &str| RunHeader {
        settings: settings.to_owned(),
        ..header()
    };
    let was = header(r#"{"seed":1,"name":"quick","stages":[{"size":24},{"size":8,"x":null}]}"#);
    let seed = header(r#"{"seed":2,"name":"quick","stages":[{"size":24},{"size":8,"x":null}]}"#);
    assert_eq!(differences(&was, &seed), ["seed (1, now 2)"]);
    let size = header(r#"{"seed":1,"name":"quick","stages":[{"size":24},{"size":9,"x":null}]}"#);
    assert_eq!(differences(&was, &size), ["stages.2.size (8, now 9)"]);
    let other = header(r#"{"seed":1,"a":1,"b":2,"c":3,"d":4}"#);
    assert_eq!(differences(&was, &other).len(), 4);
}

#[test]
fn a_follower_reads_what_is_appended_and_waits_for_the_rest_of_a_record() {
    let folder = tempfile::tempdir().unwrap();
    let whole = written(folder.path(), 3);
    let path = folder.path().join("followed");
    let mut follower = JournalFollower::new(&path);
    let mut jobs = Vec::new();
    let mut read = |follower: &mut JournalFollower| {
        let growth = follower.read(|_, event| {
            if let Event::Finished(finished) = event {
                jobs.push(finished.job().0);
            }
        });
        (growth.unwrap(), jobs.clone())
    };
    assert_eq!(read(&mut follower).0, Growth::Missing);
    // byte by byte: each result once, and no damage
    for length in 1..=whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        read(&mut follower);
    }
    let (growth, jobs) = read(&mut follower);
    assert_eq!((growth, jobs), (Growth::Unchanged, vec![1, 2, 3]));
    assert_eq!(follower.damage(), []);
    assert_eq!(follower.position(), whole.len() as u64);
}

#[test]
fn a_follower_skips_damage_and_tells_a_replaced_or_missing_journal() {
    let folder = tempfile::tempdir().unwrap();
    let mut bytes = written(folder.path(), 40);
    let path = folder.path().join(FILE);
    let middle = bytes.len() / 2;
    bytes[middle..middle + 8].fill(0);
    fs::write(&path, &bytes).unwrap();
    let mut follower = JournalFollower::new(&path);
    let read = |follower: &mut JournalFollower| {
        let mut jobs = Vec::new();
        let growth = follower.read(|_, event| {
            if let Event::Finished(finished) = event {
                jobs.push(finished.job().0);
            }
        });
        (growth.unwrap(), jobs)
    };
    let (growth, jobs) = read(&mut follower);
    assert_eq!(growth, Growth::Grown);
    assert_eq!(follower.damage().len(), 1);
    assert!(jobs.contains(&1) && jobs.contains(&40), "{jobs:?}");
    // a coordinator that takes the run over cuts a torn tail off and goes on
    let torn = [&bytes[..], &bytes[..20]].concat();
    fs::write(&path, &torn).unwrap();
    follower.read(|_, _| {}).unwrap();
    let (journal, _) = open(folder.path()).unwrap();
    journal.append(result(41)).unwrap();
    drop(journal);
    assert_eq!(read(&mut follower), (Growth::Grown, vec![41]));
    assert_eq!(follower.damage().len(), 1);
    // another journal in its place is read from its beginning
    fs::write(&path, &bytes[..middle / 2]).unwrap();
    assert_eq!(follower.read(|_, _| {}).unwrap(), Growth::Replaced);
    let (growth, jobs) = read(&mut follower);
    assert_eq!(growth, Growth::Grown);
    assert_eq!(jobs.first(), Some(&1));
    fs::remove_file(&path).unwrap();
    assert_eq!(follower.read(|_, _| {}).unwrap(), Growth::Missing);
}

#[test]
fn an_entry_of_the_study_is_written_once_and_compared_by_later_processes() {
    let scratch = tempfile::tempdir().unwrap();
    for _ in 0..2 {
        let (journal, mut begun) = open(scratch.path()).unwrap();
        for number in 0..3 {
            let event = begun.entries.enter(vec![number; 3]).unwrap();
            if let Some(event) = event {
                journal.append(event).unwrap();
            }
        }
    }
    let (journal, mut begun) = open(scratch.path()).unwrap();
    assert_eq!(begun.entries.enter(vec![0; 3]).unwrap(), None);
    let refused = begun.entries.enter(vec![8; 3]).unwrap_err();
    assert!(
        refused.to_string().contains("entry 1 of the study"),
        "{refused}"
    );
    drop(journal);
    let mut entries = Vec::new();
    fold(&scratch.path().join(FILE), |_, event| {
        if let Event::Found { number, entry } = event {
            entries.push((number, entry.into_vec()));
        }
    })
    .unwrap();
    assert_eq!(
        entries,
        [0, 1, 2].map(|number| (number.into(), vec![number; 3]))
    );
}
