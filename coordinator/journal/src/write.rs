//! Writing a journal: one thread, one flush for all queued records, and retries on a full disk.
use super::record::record;
use crate::event::Event;
use protocol::id::JobId;
use std::{
    fs::{self, File},
    io::{self, Seek, SeekFrom, Write},
    os::unix::fs::MetadataExt,
    path::{Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
        mpsc,
    },
    thread,
    time::Duration,
};

/// Pause between attempts to write to a full disk.
const RETRY: Duration = Duration::from_secs(1);

/// Report of the thread that writes the journal.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum WriterReport {
    /// Results of these jobs are on the disk.
    Stored(Vec<JobId>),
    /// Writing the journal fails for the given reason; it is retried every second.
    Paused(String),
    /// Writing the journal succeeds again.
    Resumed,
    /// The journal file was deleted or replaced; records written to it now are lost when this process ends.
    Deleted,
}

/// Storage to which journal records are written.
pub(super) trait Medium {
    /// Appends bytes; after an error any part of them may have been written.
    fn add(&mut self, bytes: &[u8]) -> io::Result<()>;
    /// Makes appended bytes durable.
    fn flush(&mut self) -> io::Result<()>;
    /// Truncates the storage to a length (bytes).
    fn cut(&mut self, length: u64) -> io::Result<()>;
    /// Returns whether the file is still at its path, i.e. was neither deleted nor replaced.
    fn is_there(&self) -> bool;
}

/// File that is expected to stay at its path.
pub(super) struct NamedFile {
    file: File,
    path: PathBuf,
}

impl NamedFile {
    /// Creates the medium from an open file and its path, which is made absolute.
    pub(super) fn new(file: File, path: &Path) -> io::Result<Self> {
        let path = path.canonicalize()?;
        Ok(Self { file, path })
    }
}

/// Returns whether a path leads to an open file.
///
/// # Errors
/// If the path cannot be examined; a missing file is no error.
pub(super) fn is_at(file: &File, path: &Path) -> io::Result<bool> {
    let own = file.metadata()?;
    match fs::metadata(path) {
        Ok(found) => Ok((found.dev(), found.ino()) == (own.dev(), own.ino())),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        Err(error) => Err(error),
    }
}

impl Medium for NamedFile {
    fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.sync_data()
    }

    fn cut(&mut self, length: u64) -> io::Result<()> {
        self.file.set_len(length)?;
        self.file.seek(SeekFrom::Start(length)).map(drop)
    }

    fn is_there(&self) -> bool {
        // what cannot be asked is told by the next attempt to write
        is_at(&self.file, &self.path).unwrap_or(true)
    }
}

/// State of the thread that writes the journal.
pub(super) struct Writer<M, F> {
    medium: M,
    /// File offset of the end of the last durable record (bytes).
    end: u64,
    /// Whether bytes of a failed write may lie behind `end`.
    needs_truncation: bool,
    said: F,
    closing: Arc<AtomicBool>,
    paused: bool,
    retry: Duration,
}

impl<M: Medium, F: FnMut(WriterReport)> Writer<M, F> {
    /// Creates a journal writer that appends from offset `end` (bytes); while `closing` is set, it gives up
    /// on a disk that cannot be written.
    pub(super) const fn new(medium: M, end: u64, said: F, closing: Arc<AtomicBool>) -> Self {
        Self {
            medium,
            end,
            needs_truncation: false,
            said,
            closing,
            paused: false,
            retry: RETRY,
        }
    }

    /// Writes queued events to the journal in batches until their sender is dropped.
    pub(super) fn run(&mut self, events: &mpsc::Receiver<Event>) {
        let mut batch = Vec::new();
        while let Ok(first) = events.recv() {
            let mut jobs = Vec::new();
            let mut is_due = false;
            for event in std::iter::once(first).chain(events.try_iter()) {
                is_due |= !matches!(event, Event::Asked(_));
                match record(&event) {
                    Ok(record) => {
                        batch.extend_from_slice(&record);
                        if let Event::Finished(finished) = &event {
                            jobs.push(finished.job());
                        }
                    }
                    // unreachable for what came over the wire, which lets pass a little less
                    Err(error) => tracing::error!(%error, "an event cannot be recorded"),
                }
            }
            // what was asked for is written with the next event: alone it is not worth a flush
            if !is_due {
                continue;
            }
            let written = self.write_with_retry(&batch);
            batch.clear();
            if !self.medium.is_there() {
                (self.said)(WriterReport::Deleted);
                return;
            }
            if !written {
                tracing::error!(
                    "{} results were not written to the journal: workers still keep them and send them again, \
                     otherwise they are computed again",
                    jobs.len()
                );
                return;
            }
            if !jobs.is_empty() {
                (self.said)(WriterReport::Stored(jobs));
            }
        }
    }

    /// Writes a batch of records, with retries until it succeeds; returns `false` if writing fails while the
    /// journal is being closed.
    fn write_with_retry(&mut self, batch: &[u8]) -> bool {
        while let Err(error) = self.write(batch) {
            if self.closing.load(Ordering::Relaxed) {
                return false;
            }
            if !self.paused {
                self.paused = true;
                (self.said)(WriterReport::Paused(error.to_string()));
            }
            // closing ends this pause at once
            thread::park_timeout(self.retry);
        }
        if std::mem::take(&mut self.paused) {
            (self.said)(WriterReport::Resumed);
        }
        true
    }

    /// Writes all of a batch or nothing: remains of a failed earlier write are truncated first.
    fn write(&mut self, batch: &[u8]) -> io::Result<()> {
        if self.needs_truncation {
            self.medium.cut(self.end)?;
            self.needs_truncation = false;
        }
        self.needs_truncation = true;
        let written = self.medium.add(batch).and_then(|()| self.medium.flush());
        if written.is_ok() {
            self.needs_truncation = false;
            self.end += batch.len() as u64;
        } else if self.medium.cut(self.end).is_ok() {
            // no torn record is left behind should this process end now
            self.needs_truncation = false;
        }
        written
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::result;
    use std::sync::Mutex;

    /// Mock disk with limited capacity, which writes as much as fits and then fails.
    #[derive(Clone)]
    struct Full(Arc<Mutex<State>>);

    struct State {
        bytes: Vec<u8>,
        room: usize,
        /// Number of flushes and truncations of the mock disk that fail before one succeeds.
        bad: usize,
        attempts: usize,
        /// Number of bytes on the mock disk that would survive a power failure.
        safe: usize,
    }

    impl State {
        fn with(room: usize, bad: usize) -> Self {
            Self {
                bytes: Vec::new(),
                room,
                bad,
                attempts: 0,
                safe: 0,
            }
        }

        fn mishap(&mut self) -> io::Result<()> {
            if self.bad > 0 {
                self.bad -= 1;
                return Err(io::Error::from(io::ErrorKind::Other));
            }
            Ok(())
        }
    }

    impl Medium for Full {
        fn add(&mut self, bytes: &[u8]) -> io::Result<()> {
            let mut state = self.0.lock().unwrap();
            state.attempts += 1;
            let fits = bytes.len().min(state.room - state.bytes.len());
            state.bytes.extend_from_slice(&bytes[..fits]);
            if fits == bytes.len() {
                Ok(())
            } else {
                Err(io::Error::from(io::ErrorKind::StorageFull))
            }
        }

        fn flush(&mut self) -> io::Result<()> {
            let mut state = self.0.lock().unwrap();
            state.mishap()?;
            state.safe = state.bytes.len();
            Ok(())
        }

        fn cut(&mut self, length: u64) -> io::Result<()> {
            let mut state = self.0.lock().unwrap();
            state.mishap()?;
            let length = usize::try_from(length).unwrap();
            assert!(length >= state.safe, "what was safe is cut off");
            state.bytes.truncate(length);
            Ok(())
        }

        fn is_there(&self) -> bool {
            true
        }
    }

    /// Writes the results of jobs 0 to `jobs` onto a mock disk that fills up and fails; `relief` is called at
    /// the first pause. Returns the bytes on the disk and the writer's reports.
    fn written(
        jobs: u64,
        state: State,
        relief: impl Fn(&mut State, &AtomicBool),
    ) -> (Vec<u8>, Vec<WriterReport>) {
        let (to, events) = mpsc::channel();
        for job in 0..jobs {
            to.send(result(job)).unwrap();
        }
        drop(to);
        let disk = Full(Arc::new(Mutex::new(state)));
        let (shared, closing) = (disk.clone(), Arc::new(AtomicBool::new(false)));
        let (mut heard, flag) = (Vec::new(), Arc::clone(&closing));
        let said = |what: WriterReport| {
            let mut state = shared.0.lock().unwrap();
            match &what {
                WriterReport::Paused(_) => relief(&mut state, &flag),
                WriterReport::Stored(_) => {
                    assert_eq!(state.safe, state.bytes.len(), "told before it is safe");
                }
                WriterReport::Resumed | WriterReport::Deleted => {}
            }
            drop(state);
            heard.push(what);
        };
        let mut writer = Writer::new(disk.clone(), 0, said, closing);
        writer.retry = Duration::from_millis(1);
        writer.run(&events);
        drop(writer);
        let bytes = disk.0.lock().unwrap().bytes.clone();
        (bytes, heard)
    }

    fn whole(jobs: u64) -> Vec<u8> {
        (0..jobs)
            .flat_map(|job| record(&result(job)).unwrap())
            .collect()
    }

    #[test]
    fn a_full_disk_pauses_and_loses_nothing_wherever_it_fills_up() {
        let expected = whole(4);
        for room in 0..expected.len() {
            for bad in 0..4 {
                let state = State::with(room, bad);
                let (bytes, heard) = written(4, state, |state, _| state.room = usize::MAX);
                assert_eq!(bytes, expected, "room {room}, {bad} mishaps");
                assert!(
                    matches!(
                        &heard[..],
                        [WriterReport::Paused(_), WriterReport::Resumed, WriterReport::Stored(jobs)]
                            if jobs.len() == 4
                    ),
                    "room {room}: {heard:?}"
                );
            }
        }
    }

    /// Checks that results are not reported as stored while written bytes cannot be flushed.
    #[test]
    fn what_is_written_and_not_flushed_is_not_stored() {
        for bad in 1..5 {
            let (bytes, heard) = written(4, State::with(usize::MAX, bad), |_, _| {});
            assert_eq!(bytes, whole(4), "{bad} mishaps");
            assert!(
                matches!(
                    &heard[..],
                    [WriterReport::Paused(_), WriterReport::Resumed, WriterReport::Stored(jobs)]
                        if jobs.len() == 4
                ),
                "{bad} mishaps: {heard:?}"
            );
        }
    }

    #[test]
    fn a_run_that_ends_while_the_disk_is_full_leaves_whole_records_and_acknowledges_nothing() {
        let state = State::with(whole(4).len() - 1, 0);
        let (bytes, heard) = written(4, state, |_, closing| {
            closing.store(true, Ordering::Relaxed);
        });
        assert!(bytes.is_empty(), "{bytes:?}");
        assert!(matches!(&heard[..], [WriterReport::Paused(_)]), "{heard:?}");
    }
}
