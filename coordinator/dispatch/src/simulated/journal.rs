//! Journal of a simulated coordinator: the bytes of a real one, in memory.
use journal::event::{Event, Finished, RunHeader};
use journal::{RecoveredRun, fold_medium, record};
use protocol::id::{ContentHash, JobId, RunId};
use std::{collections::BTreeMap, io::Cursor, mem};

/// Identifier of the simulated run.
pub(super) const RUN: RunId = RunId(1);

/// Journal of a simulated coordinator.
#[derive(Debug, Default)]
pub(super) struct SimulatedJournal {
    /// Bytes that are on the disk.
    pub(super) disk: Vec<u8>,
    /// Records that are not on the disk yet, with the jobs whose results are among them.
    queued: Vec<u8>,
    jobs: Vec<JobId>,
    pub(super) is_full: bool,
}

/// State of the run as a new coordinator process reads it.
pub(super) struct OpenedJournal {
    pub(super) run: RecoveredRun,
    pub(super) epoch: u32,
    /// First result of each job.
    pub(super) results: BTreeMap<JobId, Finished>,
}

impl SimulatedJournal {
    /// Queues an event; returns whether it is the first one in the queue.
    pub(super) fn append(&mut self, event: &Event) -> bool {
        let is_first = self.queued.is_empty();
        self.queued.extend(record(event).expect("it is short"));
        if let Event::Finished(finished) = event {
            self.jobs.push(finished.job());
        }
        is_first
    }

    /// Writes the queue to the disk and returns the jobs whose results are safe now; `None` if the disk is full.
    pub(super) fn flush(&mut self) -> Option<Vec<JobId>> {
        if self.is_full {
            return None;
        }
        self.disk.append(&mut self.queued);
        Some(mem::take(&mut self.jobs))
    }

    /// Loses the queue, of which some bytes reach the disk: `number` modulo one more than there are.
    pub(super) fn crash(&mut self, number: usize) {
        let torn = number % (self.queued.len() + 1);
        self.disk.extend_from_slice(&self.queued[..torn]);
        self.queued.clear();
        self.jobs.clear();
    }

    /// Reads the journal as a new coordinator process does, and appends the records that it begins with.
    pub(super) fn open(&mut self) -> OpenedJournal {
        let (mut run, mut results) = (RecoveredRun::default(), BTreeMap::new());
        let report = fold_medium(Cursor::new(&self.disk), 0, |entry, event| {
            if let Event::Finished(finished) = &event {
                results
                    .entry(finished.job())
                    .or_insert_with(|| (**finished).clone());
            }
            run.apply(entry, event);
        });
        let report = report.expect("what was written can be read");
        self.disk
            .truncate(usize::try_from(report.end).expect("short"));
        let epoch = run.next_epoch(&report);
        let header = RunHeader {
            kind: "simulated".to_owned(),
            case: ContentHash::of(b""),
            settings: String::new(),
        };
        for event in [
            Event::Begun { run: RUN, header },
            Event::Opened {
                epoch,
                at_unix_ms: 0,
            },
        ] {
            self.disk.extend(record(&event).expect("it is short"));
        }
        OpenedJournal {
            run,
            epoch,
            results,
        }
    }
}
