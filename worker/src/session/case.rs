//! Case of a run, as a worker obtains it: fetched once, in parts, and checked against its content hash.
use crate::pool::CaseBytes;
use protocol::id::ContentHash;

/// Case that is being fetched.
#[derive(Debug)]
pub(super) struct Incoming {
    hash: ContentHash,
    length: u64,
    bytes: Vec<u8>,
    next: u32,
}

impl Incoming {
    pub(super) const fn new(hash: ContentHash, length: u64) -> Self {
        Self {
            hash,
            length,
            bytes: Vec::new(),
            next: 0,
        }
    }

    pub(super) const fn hash(&self) -> ContentHash {
        self.hash
    }

    /// Returns the number of the part of the case that is needed next.
    pub(super) const fn next(&self) -> u32 {
        self.next
    }

    /// Adds the next part of the case; returns the case once it is complete. A complete case with a wrong
    /// hash is fetched again from the start.
    pub(super) fn take(&mut self, piece: &[u8]) -> Option<CaseBytes> {
        self.bytes.extend_from_slice(piece);
        self.next += 1;
        if (self.bytes.len() as u64) < self.length {
            return None;
        }
        let bytes = std::mem::take(&mut self.bytes);
        self.next = 0;
        let found = ContentHash::of(&bytes);
        if found != self.hash {
            tracing::warn!(expected = %self.hash, %found, "the case arrived damaged and is fetched again");
            return None;
        }
        Some(CaseBytes {
            hash: found,
            bytes: bytes.into(),
        })
    }
}
