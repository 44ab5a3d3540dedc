//! Writing a journal: one thread, one flush for all records that wait.
use super::{
    FILE, JournalError, LOCK, MARK, RECORD_HEADER, differences,
    read::{Entry, ReadReport, checksum, fold},
};
use protocol::{
    event::{Event, Finished, RunHeader},
    id::{JobId, RunId},
    wire,
};
use std::{
    collections::BTreeMap,
    fs::{File, OpenOptions, TryLockError},
    io::{self, Seek, SeekFrom, Write},
    os::unix::fs::FileExt,
    path::{Path, PathBuf},
    sync::mpsc,
    thread,
    time::Duration,
};

/// Pause between attempts to write to a full disk.
const RETRY: Duration = Duration::from_secs(1);

/// More unreadable bytes than this (bytes) are not just a first record cut short, but a journal of
/// something else: it is left alone.
const UNFINISHED: u64 = 4096;

fn torn_bytes(report: &ReadReport) -> u64 {
    report.damage.iter().map(|damage| damage.bytes).sum()
}

/// What an opened journal says of its run.
#[derive(Clone, Debug)]
pub struct Begun {
    /// The run's name.
    pub run: RunId,
    /// Which coordinator process this is, from 1.
    pub epoch: u32,
    /// Numerics of the run's first worker.
    pub model_digest: Option<String>,
    /// What reading it was like.
    pub report: ReadReport,
}

/// What the writing thread says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Appended {
    /// These results are on the disk.
    Stored(Vec<JobId>),
    /// Nothing can be written now; it is tried again each second.
    Paused(String),
    /// Writing goes on.
    Resumed,
}

/// A journal open for writing; one per run at a time.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    /// For reading results back.
    file: File,
    index: BTreeMap<JobId, Entry>,
    to_writer: Option<mpsc::Sender<Event>>,
    writer: Option<thread::JoinHandle<()>>,
    /// Held until the process ends.
    _lock: File,
}

impl Journal {
    /// Opens the journal of a run folder, or begins it; `said` is called from the writing thread.
    ///
    /// # Errors
    /// [`JournalError::Locked`], [`JournalError::Differs`], [`JournalError::Headless`] or
    /// [`JournalError::Io`].
    pub fn open(
        folder: &Path,
        header: &RunHeader,
        fresh: RunId,
        at_unix_ms: u64,
        said: impl FnMut(Appended) + Send + 'static,
    ) -> Result<(Self, Begun), JournalError> {
        let failed = |doing, path: &Path| {
            let path = path.to_owned();
            move |source| JournalError::Io {
                doing,
                path,
                source,
            }
        };
        std::fs::create_dir_all(folder).map_err(failed("create", folder))?;
        let lock = lock(folder)?;
        let path = folder.join(FILE);
        let mut file = OpenOptions::new()
            .read(true)
            .write(true)
            .create(true)
            .truncate(false)
            .open(&path)
            .map_err(failed("open", &path))?;
        let mut past = Past::default();
        let report = fold(&path, |entry, event| past.apply(entry, event))?;
        let known = identify(folder, header, &past, &report)?;
        // a torn tail is of no use to anyone
        file.set_len(report.end).map_err(failed("shorten", &path))?;
        file.seek(SeekFrom::End(0)).map_err(failed("open", &path))?;
        let run = known.unwrap_or(fresh);
        if known.is_none() {
            let begun = Event::Begun {
                run,
                header: header.clone(),
            };
            append(&mut file, &begun).map_err(failed("write", &path))?;
        }
        let epoch = past.epoch + 1;
        append(&mut file, &Event::Opened { epoch, at_unix_ms }).map_err(failed("write", &path))?;
        file.sync_data().map_err(failed("write", &path))?;
        // the folder's own entry of the file must be safe too
        let synced = File::open(folder).and_then(|folder| folder.sync_all());
        synced.map_err(failed("write", folder))?;
        let reader = File::open(&path).map_err(failed("open", &path))?;
        let (to_writer, events) = mpsc::channel();
        let writer = thread::Builder::new()
            .name("journal".to_owned())
            .spawn(move || {
                Writer {
                    file,
                    said,
                    paused: false,
                }
                .run(&events);
            })
            .map_err(failed("start the thread of", &path))?;
        let begun = Begun {
            run,
            epoch,
            model_digest: past.model_digest,
            report,
        };
        let journal = Self {
            path,
            file: reader,
            index: past.index,
            to_writer: Some(to_writer),
            writer: Some(writer),
            _lock: lock,
        };
        Ok((journal, begun))
    }

    /// Jobs whose results the journal held when it was opened.
    pub fn finished(&self) -> impl Iterator<Item = JobId> + '_ {
        self.index.keys().copied()
    }

    /// A result from before this process; `None` if there is none.
    ///
    /// # Errors
    /// [`JournalError::Io`] or [`JournalError::Wire`] if the record cannot be read again.
    pub fn recall(&self, job: JobId) -> Result<Option<Finished>, JournalError> {
        let Some(entry) = self.index.get(&job) else {
            return Ok(None);
        };
        let mut body = vec![0; entry.length as usize];
        self.file
            .read_exact_at(&mut body, entry.at)
            .map_err(|source| JournalError::Io {
                doing: "read",
                path: self.path.clone(),
                source,
            })?;
        match wire::decode(&body)? {
            Event::Finished(finished) => Ok(Some(*finished)),
            Event::Begun { .. }
            | Event::Opened { .. }
            | Event::Joined { .. }
            | Event::Left { .. }
            | Event::Closed => Ok(None),
        }
    }

    /// Hands an event to the writing thread.
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

    /// Waits until everything is on the disk.
    pub fn close(&mut self) {
        self.to_writer = None;
        if let Some(writer) = self.writer.take()
            && writer.join().is_err()
        {
            tracing::error!("the journal's thread panicked");
        }
    }

    /// Number of results it held when it was opened.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Whether it holds no result.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }
}

impl Drop for Journal {
    fn drop(&mut self) {
        self.close();
    }
}

/// What the past of a run says, folded.
#[derive(Default)]
struct Past {
    begun: Option<(RunId, RunHeader)>,
    epoch: u32,
    model_digest: Option<String>,
    index: BTreeMap<JobId, Entry>,
}

impl Past {
    fn apply(&mut self, entry: Entry, event: Event) {
        match event {
            Event::Begun { run, header } => self.begun = self.begun.take().or(Some((run, header))),
            Event::Opened { epoch, .. } => self.epoch = self.epoch.max(epoch),
            Event::Joined { model_digest, .. } => {
                self.model_digest.get_or_insert(model_digest);
            }
            Event::Finished(finished) => {
                // should a job ever be there twice, the first counts
                self.index.entry(finished.job()).or_insert(entry);
            }
            Event::Left { .. } | Event::Closed => {}
        }
    }
}

/// The run of a journal; none if it is yet to be begun.
fn identify(
    folder: &Path,
    header: &RunHeader,
    past: &Past,
    report: &ReadReport,
) -> Result<Option<RunId>, JournalError> {
    match &past.begun {
        Some((run, was)) if was == header => Ok(Some(*run)),
        Some((_, was)) => Err(JournalError::Differs {
            folder: folder.to_owned(),
            what: differences(was, header),
        }),
        None if report.records == 0 && torn_bytes(report) <= UNFINISHED => Ok(None),
        None => Err(JournalError::Headless {
            path: folder.join(FILE),
        }),
    }
}

fn lock(folder: &Path) -> Result<File, JournalError> {
    let path = folder.join(LOCK);
    let failed = |source| JournalError::Io {
        doing: "lock",
        path: path.clone(),
        source,
    };
    let lock = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(false)
        .open(&path);
    let lock = lock.map_err(failed)?;
    match lock.try_lock() {
        Ok(()) => Ok(lock),
        Err(TryLockError::WouldBlock) => Err(JournalError::Locked {
            folder: folder.to_owned(),
        }),
        Err(TryLockError::Error(source)) => Err(failed(source)),
    }
}

fn record(event: &Event) -> Result<Vec<u8>, wire::WireError> {
    let body = wire::encode(event)?;
    let length = u32::try_from(body.len()).map_err(|_| wire::WireError::TooLong {
        bytes: body.len(),
        limit: wire::BODY_LIMIT,
    })?;
    let mut record = Vec::with_capacity(RECORD_HEADER + body.len());
    record.extend_from_slice(&MARK);
    record.extend_from_slice(&length.to_le_bytes());
    record.extend_from_slice(&checksum(length, &body).to_le_bytes());
    record.extend_from_slice(&body);
    Ok(record)
}

fn append(file: &mut File, event: &Event) -> io::Result<()> {
    file.write_all(&record(event).map_err(io::Error::other)?)
}

struct Writer<F> {
    file: File,
    said: F,
    paused: bool,
}

impl<F: FnMut(Appended)> Writer<F> {
    fn run(&mut self, events: &mpsc::Receiver<Event>) {
        while let Ok(first) = events.recv() {
            let mut batch = Vec::new();
            let mut jobs = Vec::new();
            for event in std::iter::once(first).chain(events.try_iter()) {
                match record(&event) {
                    Ok(record) => batch.extend_from_slice(&record),
                    // unreachable for what came over the wire, which has the same limit
                    Err(error) => tracing::error!(%error, "an event cannot be recorded"),
                }
                if let Event::Finished(finished) = &event {
                    jobs.push(finished.job());
                }
            }
            while let Err(error) = self.write(&batch) {
                if !self.paused {
                    self.paused = true;
                    (self.said)(Appended::Paused(error.to_string()));
                }
                thread::sleep(RETRY);
            }
            if std::mem::take(&mut self.paused) {
                (self.said)(Appended::Resumed);
            }
            if !jobs.is_empty() {
                (self.said)(Appended::Stored(jobs));
            }
        }
    }

    /// Writes all or nothing.
    fn write(&mut self, batch: &[u8]) -> io::Result<()> {
        let before = self.file.stream_position()?;
        let written = self
            .file
            .write_all(batch)
            .and_then(|()| self.file.sync_data());
        if written.is_err() {
            self.file.set_len(before)?;
            self.file.seek(SeekFrom::Start(before))?;
        }
        written
    }
}
