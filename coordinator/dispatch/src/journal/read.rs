//! Reading a journal, with recovery from damage.
use super::{
    error::JournalError,
    record::{MARK, RECORD_HEADER, checksum},
};
use protocol::{
    event::Event,
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
    /// File offset of the end of the last readable record (bytes).
    pub end: u64,
}

/// Calls `apply` for each readable event of a journal, in order.
///
/// # Errors
/// [`JournalError::Io`] if the file cannot be read, [`JournalError::Version`] if all that is sound
/// in it was written by another version; damage is no error.
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
    mut apply: impl FnMut(JournalEntry, Event),
) -> Result<ReadReport, JournalError> {
    let failed = |source| JournalError::Io {
        doing: "read",
        path: path.to_owned(),
        source,
    };
    let file = File::open(path).map_err(failed)?;
    let length = file.metadata().map_err(failed)?.len();
    let mut reader = Reader {
        file: BufReader::with_capacity(1 << 16, file),
        at: from,
        length,
        foreign: None,
    };
    reader.file.seek(SeekFrom::Start(from)).map_err(failed)?;
    let mut report = ReadReport {
        end: from,
        ..ReadReport::default()
    };
    let mut lost_from = None;
    while reader.at < length {
        let at = reader.at;
        if let Some((entry, event)) = reader.record().map_err(failed)? {
            if let Some(from) = lost_from.take() {
                report.damage.push(Damage {
                    at: from,
                    bytes: at - from,
                    torn: false,
                });
            }
            report.records += 1;
            report.end = reader.at;
            apply(entry, event);
        } else {
            lost_from.get_or_insert(at);
            reader.seek_mark(at + 1).map_err(failed)?;
        }
    }
    if let Some(from) = lost_from {
        report.damage.push(Damage {
            at: from,
            bytes: length - from,
            torn: true,
        });
    }
    match reader.foreign {
        Some(found) if report.end == 0 => Err(JournalError::Version {
            path: path.to_owned(),
            found,
        }),
        Some(_) | None => Ok(report),
    }
}

struct Reader {
    file: BufReader<File>,
    at: u64,
    length: u64,
    /// Format version of an intact record that another version of the program wrote, if one was found.
    foreign: Option<u8>,
}

impl Reader {
    /// Reads the record at the current offset; `None` if there is no intact record of this version.
    fn record(&mut self) -> io::Result<Option<(JournalEntry, Event)>> {
        let left = self.length - self.at;
        let mut header = [0; RECORD_HEADER];
        if left < RECORD_HEADER as u64 {
            return Ok(None);
        }
        self.file.read_exact(&mut header)?;
        let [m0, m1, m2, m3, l0, l1, l2, l3, c0, c1, c2, c3] = header;
        let length = u32::from_le_bytes([l0, l1, l2, l3]);
        let fits =
            length as usize <= BODY_LIMIT && u64::from(length) + RECORD_HEADER as u64 <= left;
        let [h0, h1, j, version] = MARK;
        if [m0, m1, m2] != [h0, h1, j] || !fits {
            return Ok(None);
        }
        let mut body = vec![0; length as usize];
        self.file.read_exact(&mut body)?;
        if checksum(length, &body) != u32::from_le_bytes([c0, c1, c2, c3]) {
            return Ok(None);
        }
        if m3 != version {
            self.foreign = Some(m3.wrapping_sub(b'0'));
            return Ok(None);
        }
        let Ok(event) = wire::decode(&body) else {
            return Ok(None);
        };
        let entry = JournalEntry {
            at: self.at + RECORD_HEADER as u64,
            length,
        };
        self.at = entry.at + u64::from(length);
        Ok(Some((entry, event)))
    }

    /// Moves to the next record mark at or after an offset, or to the end of the file.
    fn seek_mark(&mut self, from: u64) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(from))?;
        let mut last = [0; 4];
        for (place, byte) in (from..).zip(self.file.by_ref().bytes()) {
            last.rotate_left(1);
            last[3] = byte?;
            if last == MARK && place >= from + 3 {
                self.at = place - 3;
                self.file.seek(SeekFrom::Start(self.at))?;
                return Ok(());
            }
        }
        self.at = self.length;
        Ok(())
    }
}
