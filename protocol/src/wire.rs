//! The encoding: values to bytes, and the frame around them. Knows no message.
//!
//! ```text
//! | "HH" | version u8 | kind u8 | run u64 | length u32 | crc32 u32 | body ... |
//! ```
//!
//! Numbers are little endian with fixed width, so a body is laid out by inspection. The body is
//! bincode (serde mode), which does not describe itself: bytes of another shape decode without an
//! error. Therefore the kind is checked before the body is touched, and a body must be used up to
//! its last byte. No wire type may be recursive or hold a vector of zero-sized values: bincode's
//! limit does not cover those.
use crate::id::RunId;
use serde::{Serialize, de::DeserializeOwned};

/// Version of the frame and of everything in it; both ends must have the same. A test holds the form
/// of every message to it: whoever changes one raises this number.
pub const VERSION: u8 = 12;
/// The most a body may hold (bytes): a long simulation with its pictures fits.
pub const BODY_LIMIT: usize = 16 << 20;
/// What an outcome may gain at each of its stations: from its slot to its worker, to the coordinator,
/// into the journal (bytes). What passes one must fit through the next.
const ENVELOPE: usize = 64;
/// Bytes before the body.
pub const HEADER_BYTES: usize = 20;
const MAGIC: [u8; 2] = *b"HH";

/// What kind of body a frame carries; a new kind is a new number, never a reused one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// [`crate::message::ToWorker`].
    ToWorker,
    /// [`crate::message::FromWorker`].
    FromWorker,
    /// [`crate::message::ToSlot`].
    ToSlot,
    /// [`crate::message::FromSlot`].
    FromSlot,
}

impl Kind {
    /// Every kind there is.
    pub const ALL: [Self; 4] = [
        Self::ToWorker,
        Self::FromWorker,
        Self::ToSlot,
        Self::FromSlot,
    ];

    /// The number on the wire.
    pub const fn number(self) -> u8 {
        match self {
            Self::ToWorker => 1,
            Self::FromWorker => 2,
            Self::ToSlot => 3,
            Self::FromSlot => 4,
        }
    }

    /// The most that a body of this kind may hold (bytes). What comes from slots is written down in
    /// the end, with more around it at each station.
    pub const fn limit(self) -> usize {
        match self {
            Self::ToWorker | Self::ToSlot => BODY_LIMIT,
            Self::FromWorker => BODY_LIMIT - ENVELOPE,
            Self::FromSlot => BODY_LIMIT - 2 * ENVELOPE,
        }
    }
}

/// Why bytes are not a message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WireError {
    /// The frame ends before its header or body does.
    #[error("the frame is cut: {found} of {expected} bytes")]
    Cut {
        /// Bytes there are.
        found: usize,
        /// Bytes there should be.
        expected: usize,
    },
    /// The first two bytes are not ours.
    #[error("not a horsehead frame: it begins with {found:02x?}")]
    Magic {
        /// What it begins with.
        found: [u8; 2],
    },
    /// The other end speaks another version.
    #[error(
        "wire version {found}, but this build speaks {VERSION}: use the same build on both ends"
    )]
    Version {
        /// The other end's version.
        found: u8,
    },
    /// A kind that this reader does not expect.
    #[error("frame kind {found}, expected {expected}")]
    Kind {
        /// The kind in the frame.
        found: u8,
        /// The kind that was asked for.
        expected: u8,
    },
    /// The body is longer than anyone may send.
    #[error("a body of {bytes} bytes exceeds the limit of {limit}")]
    TooLong {
        /// Length of the body.
        bytes: usize,
        /// The limit.
        limit: usize,
    },
    /// The checksum does not fit the body.
    #[error("the checksum of the body is {found:08x}, its frame says {expected:08x}")]
    Checksum {
        /// Computed from the body.
        found: u32,
        /// As stated.
        expected: u32,
    },
    /// Bytes remain after the value.
    #[error("{bytes} bytes are left over after the value")]
    Leftover {
        /// How many.
        bytes: usize,
    },
    /// The body is no value of the expected type.
    #[error("the body cannot be read: {reason}")]
    Malformed {
        /// The decoder's words.
        reason: String,
    },
}

/// A frame whose header and checksum are in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// The run it belongs to; 0 before a worker has been told.
    pub run: RunId,
    /// The encoded value.
    pub body: &'a [u8],
}

/// Encodes a value without a frame: for content that is named by its hash.
///
/// # Errors
/// [`WireError::TooLong`] beyond [`BODY_LIMIT`]; [`WireError::Malformed`] if the value cannot be
/// encoded.
pub fn encode<T: Serialize>(value: &T) -> Result<Vec<u8>, WireError> {
    let mut bytes = Vec::new();
    append(&mut bytes, value, BODY_LIMIT)?;
    Ok(bytes)
}

/// Decodes a value that fills `bytes` to the last one.
///
/// # Errors
/// [`WireError::TooLong`], [`WireError::Malformed`] or [`WireError::Leftover`].
pub fn decode<T: DeserializeOwned>(bytes: &[u8]) -> Result<T, WireError> {
    within(bytes.len(), BODY_LIMIT)?;
    let (value, used) = bincode::serde::decode_from_slice(bytes, config()).map_err(|error| {
        WireError::Malformed {
            reason: error.to_string(),
        }
    })?;
    match bytes.len() - used {
        0 => Ok(value),
        bytes => Err(WireError::Leftover { bytes }),
    }
}

/// Encodes a value into a frame.
///
/// # Errors
/// As [`encode`], with the limit of the kind.
pub fn seal<T: Serialize>(kind: Kind, run: RunId, value: &T) -> Result<Vec<u8>, WireError> {
    let mut frame = Vec::with_capacity(256);
    frame.extend_from_slice(&MAGIC);
    frame.push(VERSION);
    frame.push(kind.number());
    frame.extend_from_slice(&run.0.to_le_bytes());
    frame.extend_from_slice(&[0; 8]);
    append(&mut frame, value, kind.limit())?;
    let body = frame.get(HEADER_BYTES..).unwrap_or_default();
    let crc = crc32fast::hash(body);
    let length = u32::try_from(body.len()).map_err(|_| WireError::TooLong {
        bytes: body.len(),
        limit: kind.limit(),
    })?;
    frame[12..16].copy_from_slice(&length.to_le_bytes());
    frame[16..20].copy_from_slice(&crc.to_le_bytes());
    Ok(frame)
}

/// Checks a frame and returns its body, still encoded.
///
/// # Errors
/// Any of [`WireError`] but [`WireError::Malformed`].
pub fn open(kind: Kind, frame: &[u8]) -> Result<Frame<'_>, WireError> {
    let (header, body) = frame
        .split_first_chunk::<HEADER_BYTES>()
        .ok_or(WireError::Cut {
            found: frame.len(),
            expected: HEADER_BYTES,
        })?;
    let length = check_header(kind, header)?;
    match body.len() {
        found if found < length => Err(WireError::Cut {
            found: frame.len(),
            expected: HEADER_BYTES + length,
        }),
        found if found > length => Err(WireError::Leftover {
            bytes: found - length,
        }),
        _ => {
            let expected = word(header, 16);
            let found = crc32fast::hash(body);
            if found == expected {
                Ok(Frame {
                    run: RunId(u64::from(word(header, 4)) | u64::from(word(header, 8)) << 32),
                    body,
                })
            } else {
                Err(WireError::Checksum { found, expected })
            }
        }
    }
}

/// Opens a frame and decodes its body.
///
/// # Errors
/// Any of [`WireError`].
pub fn unseal<T: DeserializeOwned>(kind: Kind, frame: &[u8]) -> Result<(RunId, T), WireError> {
    let opened = open(kind, frame)?;
    Ok((opened.run, decode(opened.body)?))
}

/// The length of the body that follows a header on a stream (bytes).
///
/// # Errors
/// What [`open`] finds wrong with a header.
pub fn body_length(kind: Kind, header: &[u8; HEADER_BYTES]) -> Result<usize, WireError> {
    check_header(kind, header)
}

fn check_header(kind: Kind, header: &[u8; HEADER_BYTES]) -> Result<usize, WireError> {
    let [m0, m1, version, found, ..] = *header;
    if [m0, m1] != MAGIC {
        return Err(WireError::Magic { found: [m0, m1] });
    }
    if version != VERSION {
        return Err(WireError::Version { found: version });
    }
    if found != kind.number() {
        return Err(WireError::Kind {
            found,
            expected: kind.number(),
        });
    }
    let length = word(header, 12) as usize;
    within(length, kind.limit())?;
    Ok(length)
}

const fn within(bytes: usize, limit: usize) -> Result<(), WireError> {
    if bytes > limit {
        return Err(WireError::TooLong { bytes, limit });
    }
    Ok(())
}

fn word(header: &[u8; HEADER_BYTES], at: usize) -> u32 {
    let mut bytes = [0; 4];
    bytes.copy_from_slice(&header[at..at + 4]);
    u32::from_le_bytes(bytes)
}

fn append<T: Serialize>(to: &mut Vec<u8>, value: &T, limit: usize) -> Result<(), WireError> {
    let before = to.len();
    bincode::serde::encode_into_std_write(value, to, config()).map_err(|error| {
        WireError::Malformed {
            reason: error.to_string(),
        }
    })?;
    within(to.len() - before, limit)
}

const fn config() -> impl bincode::config::Config {
    bincode::config::standard()
        .with_little_endian()
        .with_fixed_int_encoding()
        .with_limit::<BODY_LIMIT>()
}
