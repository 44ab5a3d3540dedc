//! On-disk format of a journal: file names, record mark, checksum and encoding.
use crate::event::Event;
use protocol::wire;

/// Name of the journal within a run's folder.
pub const FILE: &str = "journal.hhj";
/// Name of the copy of the journal's first record within a run's folder.
pub const HEAD: &str = "journal.head";
/// Name of the file within a run's folder that is locked beside the journal: earlier versions lock it alone.
pub const LOCK: &str = "lock";

/// Version of the journal: raised when the form of a record changes, which is that of an [`Event`] and of the study's
/// entries. Journals up to version 15 had that of the wire protocol.
pub const VERSION: u8 = 22;

/// Mark at the start of each journal record; the last byte is the format version, as a digit.
pub const MARK: [u8; 4] = [b'H', b'H', b'J', b'0' + VERSION];
/// Length of the header before the body of a journal record (bytes).
pub(super) const RECORD_HEADER: usize = 12;

/// Encodes an event as a journal record: header and body.
///
/// # Errors
/// [`wire::WireError::TooLong`] if the body exceeds the limit of what one record may hold.
pub fn record(event: &Event) -> Result<Vec<u8>, wire::WireError> {
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

/// Returns the checksum of a journal record, computed over the body's length too, so that a damaged length is
/// detected.
pub(super) fn checksum(length: u32, body: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(&length.to_le_bytes());
    hasher.update(body);
    hasher.finalize()
}
