//! Opening or continuing a journal for writing.
use super::{
    differences::differences,
    entries::StudyEntries,
    error::JournalError,
    head,
    index::Results,
    read::{ReadReport, fold},
    record::{FILE, LOCK, record},
    recovered::{RecoveredRun, damaged_bytes},
    write::{NamedFile, Writer, WriterReport, is_at},
};
use crate::event::{Event, Finished, RunHeader};
use protocol::{
    id::{JobId, RunId, WorkerId},
    proof::ReferenceResult,
};
use std::{
    collections::BTreeSet,
    fs::{File, OpenOptions, TryLockError},
    io::{self, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
};

/// Maximum length of an unreadable journal that still counts as a truncated first record (bytes). A longer
/// file is taken for something other than a journal and left untouched.
const MAX_UNFINISHED_BYTES: u64 = 4096;

/// State of a run as read from its journal at opening.
#[derive(Clone, Debug)]
pub struct OpenedRun {
    /// Identifier of the run.
    pub run: RunId,
    /// Number of this coordinator process within the run, from 1; higher than the number of processes if
    /// records of openings may have been lost.
    pub epoch: u32,
    /// Digest of the model (numerics) on the run's first worker.
    pub model_digest: Option<String>,
    /// Result of the case's reference individual on the run's first worker.
    pub proof: Option<ReferenceResult>,
    /// Workers connected when the last process ended without closing the run; they may still hold jobs and
    /// results.
    pub present: BTreeSet<WorkerId>,
    /// Entries of the study, with those that earlier processes recorded.
    pub entries: StudyEntries,
    /// Report on reading the journal: number of records, and damage found.
    pub report: ReadReport,
}

/// A journal open for writing; one per run at a time.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    results: Results,
    /// Jobs whose requests the journal held when it was opened.
    asked: BTreeSet<JobId>,
    to_writer: Option<mpsc::Sender<Event>>,
    writer: Option<thread::JoinHandle<()>>,
    closing: Arc<AtomicBool>,
    /// Locks of the journal and of the file that earlier versions lock.
    _locks: [RunLock; 2],
}

impl Journal {
    /// Opens or creates the journal of a run folder; `said` receives the reports of the writing thread, on
    /// that thread.
    ///
    /// # Errors
    /// [`JournalError::Locked`], [`JournalError::Differs`], [`JournalError::Unidentified`],
    /// [`JournalError::Version`] or [`JournalError::Io`].
    pub fn open(
        folder: &Path,
        header: &RunHeader,
        fresh: RunId,
        at_unix_ms: u64,
        said: impl FnMut(WriterReport) + Send + 'static,
    ) -> Result<(Self, OpenedRun), JournalError> {
        let failed = |doing, path: &Path| {
            let path = path.to_owned();
            move |source| JournalError::Io {
                doing,
                path,
                source,
            }
        };
        std::fs::create_dir_all(folder).map_err(failed("create", folder))?;
        let path = folder.join(FILE);
        // coordinators of earlier versions lock this file alone
        let locks = [lock(folder, &folder.join(LOCK))?, lock(folder, &path)?];
        let mut file = locks[1].0.try_clone().map_err(failed("open", &path))?;
        let mut past = RecoveredRun::default();
        let report = fold(&path, |entry, event| past.apply(entry, event))?;
        let copy = head::read(folder)?;
        let run = identify(folder, header, &past, copy.as_ref(), &report)?.unwrap_or(fresh);
        // a torn tail is of no use to anyone
        file.set_len(report.end).map_err(failed("shorten", &path))?;
        file.seek(SeekFrom::End(0)).map_err(failed("open", &path))?;
        let epoch = past.next_epoch(&report);
        let header = header.clone();
        if copy.is_none_or(|copy| copy != (run, header.clone())) {
            head::write(folder, run, &header)?;
        }
        // repeated at each opening: the first one may be lost
        for event in [
            Event::Begun { run, header },
            Event::Opened { epoch, at_unix_ms },
        ] {
            file.write_all(&record(&event)?)
                .map_err(failed("write", &path))?;
        }
        file.sync_data().map_err(failed("write", &path))?;
        // the folder's own entries of the files must be safe too
        let synced = File::open(folder).and_then(|folder| folder.sync_all());
        synced.map_err(failed("write", folder))?;
        let closing = Arc::new(AtomicBool::new(false));
        let (to_writer, events) = mpsc::channel();
        let end = file.stream_position().map_err(failed("open", &path))?;
        let medium = NamedFile::new(file, &path).map_err(failed("open", &path))?;
        let mut writing = Writer::new(medium, end, said, Arc::clone(&closing));
        let writer = thread::Builder::new()
            .name("journal".to_owned())
            .spawn(move || writing.run(&events))
            .map_err(failed("start the thread of", &path))?;
        let begun = OpenedRun {
            run,
            epoch,
            model_digest: past.model_digest,
            proof: past.proof,
            present: past.present.into_keys().collect(),
            entries: StudyEntries::new(&path, past.found),
            report,
        };
        let journal = Self {
            results: Results::new(&path, past.results)?,
            asked: past.asked,
            path,
            to_writer: Some(to_writer),
            writer: Some(writer),
            closing,
            _locks: locks,
        };
        Ok((journal, begun))
    }

    /// Returns the jobs whose results the journal held when it was opened, in ascending order.
    pub fn finished(&self) -> impl Iterator<Item = JobId> + '_ {
        self.results.jobs()
    }

    /// Reads a result of an earlier coordinator process; `None` if the job has none.
    ///
    /// # Errors
    /// [`JournalError::Io`] or [`JournalError::Wire`] if the record cannot be read.
    pub fn recall(&self, job: JobId) -> Result<Option<Finished>, JournalError> {
        self.results.recall(job)
    }

    /// Returns whether the journal held the request of a job when it was opened.
    pub fn holds_request(&self, job: JobId) -> bool {
        self.asked.contains(&job)
    }

    /// Queues an event for the writing thread.
    ///
    /// # Errors
    /// [`JournalError::Closed`] if that thread has ended.
    pub fn append(&self, event: Event) -> Result<(), JournalError> {
        let sent = self
            .to_writer
            .as_ref()
            .is_some_and(|to| to.send(event).is_ok());
        if sent {
            Ok(())
        } else {
            Err(JournalError::Closed)
        }
    }

    /// Returns the error for a journal that was deleted during the run.
    pub fn deleted(&self) -> JournalError {
        JournalError::Deleted {
            path: self.path.clone(),
        }
    }

    /// Waits until all queued events are on the disk; gives up if the disk does not accept them at that
    /// moment.
    pub fn close(&mut self) {
        self.closing.store(true, Ordering::Relaxed);
        self.to_writer = None;
        if let Some(writer) = self.writer.take() {
            writer.thread().unpark();
            if writer.join().is_err() {
                tracing::error!("the journal's thread panicked");
            }
        }
    }

    /// Returns the number of results that the journal held when it was opened.
    pub const fn len(&self) -> usize {
        self.results.len()
    }

    /// Returns whether the journal held no result when it was opened.
    pub const fn is_empty(&self) -> bool {
        self.results.len() == 0
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        self.close();
    }
}

/// Returns the identifier of the journal's run; `None` if the run has not begun.
fn identify(
    folder: &Path,
    header: &RunHeader,
    past: &RecoveredRun,
    copy: Option<&(RunId, RunHeader)>,
    report: &ReadReport,
) -> Result<Option<RunId>, JournalError> {
    let nothing = report.records == 0 && damaged_bytes(report) <= MAX_UNFINISHED_BYTES;
    // a copy beside nothing binds nobody
    let copy = copy.filter(|(_, was)| !nothing || was == header);
    match past.begun.as_ref().or(copy) {
        Some((run, was)) if was == header => Ok(Some(*run)),
        Some((_, was)) => Err(JournalError::Differs {
            folder: folder.to_owned(),
            what: differences(was, header),
        }),
        None if nothing => Ok(None),
        None => Err(JournalError::Unidentified {
            path: folder.join(FILE),
        }),
    }
}

/// File that this process has locked. The lock is released explicitly on drop: a child process being spawned by another thread briefly
/// inherits all open files, and would keep the lock.
#[derive(Debug)]
struct RunLock(File);

impl Drop for RunLock {
    fn drop(&mut self) {
        // closing the file gives it back as well
        drop(self.0.unlock());
    }
}

/// Deletes the folder of a run that no coordinator works on; a missing folder is no error.
///
/// # Errors
/// [`JournalError::Locked`] if a coordinator works on the run, [`JournalError::Io`] if the folder cannot be deleted.
pub fn discard(folder: &Path) -> Result<(), JournalError> {
    if !folder.exists() {
        return Ok(());
    }
    let _locks = [
        lock(folder, &folder.join(LOCK))?,
        lock(folder, &folder.join(FILE))?,
    ];
    std::fs::remove_dir_all(folder).map_err(|source| JournalError::Io {
        doing: "delete",
        path: folder.to_owned(),
        source,
    })
}

/// Opens or creates a file of a run folder and locks it.
fn lock(folder: &Path, path: &Path) -> Result<RunLock, JournalError> {
    let failed = |source: io::Error| JournalError::Io {
        doing: "lock",
        path: path.to_owned(),
        source,
    };
    loop {
        let mut options = OpenOptions::new();
        let options = options.read(true).write(true).create(true).truncate(false);
        let file = options.open(path).map_err(failed)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                return Err(JournalError::Locked {
                    folder: folder.to_owned(),
                });
            }
            Err(TryLockError::Error(source)) => return Err(failed(source)),
        }
        // a file that was replaced between its opening and its locking is another coordinator's by now
        let lock = RunLock(file);
        if is_at(&lock.0, path).map_err(failed)? {
            return Ok(lock);
        }
    }
}
