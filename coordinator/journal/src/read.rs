//! Reading a journal, with recovery from damage.
use super::{
    error::JournalError,
    record::{MARK, RECORD_HEADER, checksum},
};
use crate::event::Event;
use protocol::{
    job::{Failure, Outcome},
    wire::{self, BODY_LIMIT},
};
use std::{
    fmt,
    fs::File,
    io::{self, BufReader, Read, Seek, SeekFrom},
    path::Path,
};

/// Unreadable stretch of a journal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Damage {
    /// Offset of the stretch in the file (bytes).
    pub at: u64,
    /// Length of the stretch (bytes).
    pub bytes: u64,
    /// Whether nothing readable follows the stretch: a record cut short by a crash.
    pub torn: bool,
}

impl fmt::Display for Damage {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { at, bytes, torn } = self;
        if *torn {
            write!(
                to,
                "the journal ends in an unfinished record ({bytes} bytes at offset {at}), which was dropped"
            )
        } else {
            write!(
                to,
                "{bytes} bytes of the journal at offset {at} are damaged and were skipped; the results in them are computed again"
            )
        }
    }
}

/// Maximum number of damaged stretches that are named individually.
const MOST_NAMED: usize = 3;

/// Describes damaged stretches of a journal in words: the first ones individually, then the total of the
/// others.
pub fn describe_damage(damage: &[Damage]) -> Vec<String> {
    let named = damage.iter().take(MOST_NAMED).map(ToString::to_string);
    let mut words: Vec<String> = named.collect();
    let more = damage.get(MOST_NAMED..).unwrap_or_default();
    if !more.is_empty() {
        let bytes: u64 = more.iter().map(|damage| damage.bytes).sum();
        words.push(format!(
            "{} more stretches of the journal are damaged, {bytes} bytes in total",
            more.len()
        ));
    }
    words
}

/// Location of a record's body in the journal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JournalEntry {
    /// Offset of the body from the start of the file (bytes).
    pub at: u64,
    /// Length of the body (bytes).
    pub length: u32,
}

/// Report on reading a journal: number of records, damage and end.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ReadReport {
    /// Number of records read.
    pub records: u64,
    /// Damaged stretches that were skipped.
    pub damage: Vec<Damage>,
    /// File offset of the end of the last intact record (bytes).
    pub end: u64,
}

/// Calls `apply` for each readable event of a journal, in order. Records of lost workers, which earlier versions
/// wrote as results, are left out: their jobs have no result.
///
/// # Errors
/// [`JournalError::Io`] if the file cannot be read; [`JournalError::Version`] or [`JournalError::Undecodable`] if it
/// holds an intact record that this version cannot read. Damage is no error.
pub fn fold(
    path: &Path,
    apply: impl FnMut(JournalEntry, Event),
) -> Result<ReadReport, JournalError> {
    fold_from(path, 0, apply)
}

/// Calls `apply` for each readable event of a journal after the offset `from` (bytes), which is the end of a
/// record. The reported damage lies after `from`, too; the reported end is `from` if nothing readable follows.
///
/// # Errors
/// As [`fold`].
pub(super) fn fold_from(
    path: &Path,
    from: u64,
    apply: impl FnMut(JournalEntry, Event),
) -> Result<ReadReport, JournalError> {
    let file = File::open(path).map_err(ReadError::Io);
    let read = file.and_then(|file| fold_medium(&file, from, apply));
    read.map_err(|error| error.of(path))
}

/// Error of reading a journal, without its path.
#[derive(Debug)]
pub enum ReadError {
    /// The medium cannot be read.
    Io(io::Error),
    /// An intact record was written by another version of this program.
    Version(u8),
    /// An intact record of this version at this offset (bytes) cannot be decoded.
    Undecodable(u64),
}

impl From<io::Error> for ReadError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl ReadError {
    fn of(self, path: &Path) -> JournalError {
        let path = path.to_owned();
        match self {
            Self::Io(source) => JournalError::Io {
                doing: "read",
                path,
                source,
            },
            Self::Version(found) => JournalError::Version { path, found },
            Self::Undecodable(at) => JournalError::Undecodable { path, at },
        }
    }
}

/// Calls `apply` for each readable event in a medium after the offset `from` (bytes), which is the end of a
/// record.
///
/// # Errors
/// [`ReadError`] as [`fold`].
pub fn fold_medium<M: Read + Seek>(
    mut medium: M,
    from: u64,
    mut apply: impl FnMut(JournalEntry, Event),
) -> Result<ReadReport, ReadError> {
    let length = medium.seek(SeekFrom::End(0))?;
    let mut reader = Reader {
        medium: BufReader::with_capacity(1 << 16, medium),
        at: from,
        length,
    };
    reader.medium.seek(SeekFrom::Start(from))?;
    let mut report = ReadReport {
        end: from,
        ..ReadReport::default()
    };
    let (mut lost_from, mut foreign) = (None, None);
    while reader.at < length {
        let at = reader.at;
        match reader.record()? {
            Record::Own(entry, event) => {
                if let Some(from) = lost_from.take() {
                    report.damage.push(Damage {
                        at: from,
                        bytes: at - from,
                        torn: false,
                    });
                }
                report.records += 1;
                report.end = reader.at;
                if !is_lost(&event) {
                    apply(entry, event);
                }
            }
            // a process of another version begins with two records, so that a single one has a damaged version
            Record::Foreign(version) if foreign.replace(version) == Some(version) => {
                return Err(ReadError::Version(version));
            }
            Record::Foreign(_) => {
                lost_from.get_or_insert(at);
                report.end = reader.at;
            }
            Record::Damaged => {
                lost_from.get_or_insert(at);
                reader.seek_mark(at + 1)?;
            }
        }
    }
    if let Some(from) = lost_from {
        report.damage.push(Damage {
            at: from,
            bytes: length - from,
            torn: report.end <= from,
        });
    }
    match foreign.filter(|_| report.records == 0 && from == 0) {
        Some(version) => Err(ReadError::Version(version)),
        None => Ok(report),
    }
}

/// Returns whether an event is the result of a job whose workers were lost, which earlier versions recorded.
fn is_lost(event: &Event) -> bool {
    let Event::Finished(finished) = event else {
        return false;
    };
    matches!(finished.outcome, Outcome::Failed(Failure::Lost { .. }))
}

/// What stands at an offset of a journal.
enum Record {
    /// Intact record of this version.
    Own(JournalEntry, Event),
    /// Intact record with the mark of another version.
    Foreign(u8),
    /// No intact record.
    Damaged,
}

struct Reader<M> {
    medium: BufReader<M>,
    at: u64,
    length: u64,
}

impl<M: Read + Seek> Reader<M> {
    /// Reads what stands at the current offset, and moves behind an intact record.
    fn record(&mut self) -> Result<Record, ReadError> {
        let left = self.length - self.at;
        let mut header = [0; RECORD_HEADER];
        if left < RECORD_HEADER as u64 {
            return Ok(Record::Damaged);
        }
        self.medium.read_exact(&mut header)?;
        let [m0, m1, m2, m3, l0, l1, l2, l3, c0, c1, c2, c3] = header;
        let length = u32::from_le_bytes([l0, l1, l2, l3]);
        let fits =
            length as usize <= BODY_LIMIT && u64::from(length) + RECORD_HEADER as u64 <= left;
        let [h0, h1, j, version] = MARK;
        if [m0, m1, m2] != [h0, h1, j] || !fits {
            return Ok(Record::Damaged);
        }
        let mut body = vec![0; length as usize];
        self.medium.read_exact(&mut body)?;
        if checksum(length, &body) != u32::from_le_bytes([c0, c1, c2, c3]) {
            return Ok(Record::Damaged);
        }
        let start = self.at;
        let entry = JournalEntry {
            at: start + RECORD_HEADER as u64,
            length,
        };
        self.at = entry.at + u64::from(length);
        if m3 != version {
            return Ok(Record::Foreign(m3.wrapping_sub(b'0')));
        }
        // what is intact is not damage: a build that can read it needs it
        let event = wire::decode(&body).map_err(|_| ReadError::Undecodable(start))?;
        Ok(Record::Own(entry, event))
    }

    /// Moves to the next record mark of any version at or after an offset, or to the end of the medium.
    fn seek_mark(&mut self, from: u64) -> io::Result<()> {
        const LETTERS: usize = MARK.len() - 1;
        self.medium.seek(SeekFrom::Start(from))?;
        let mut last = [0; LETTERS];
        for (place, byte) in (from..).zip(self.medium.by_ref().bytes()) {
            last.rotate_left(1);
            last[LETTERS - 1] = byte?;
            if MARK.starts_with(&last) && place + 1 >= from + LETTERS as u64 {
                self.at = place + 1 - LETTERS as u64;
                self.medium.seek(SeekFrom::Start(self.at))?;
                return Ok(());
            }
        }
        self.at = self.length;
        Ok(())
    }
}
