//! Encoding of values to bytes, and the frame around them; independent of the message types.
//!
//! ```text
//! | "HH" | version u8 | kind u8 | run u64 | length u32 | crc32 u32 | body ... |
//! ```
//!
//! Numbers are little endian with fixed width, so that a body can be read by inspection. The body is bincode
//! (serde mode), which is not self-describing: bytes of another type may decode without an error. Therefore
//! the kind is checked before the body is decoded, and the body must be consumed to its last byte. No wire
//! type may be recursive or hold a vector of zero-sized values: bincode's limit does not cover those.
use crate::id::RunId;
use serde::{Serialize, de::DeserializeOwned};

/// Version of the frame and of everything in it; both peers must have the same. A test compares the layout of
/// every message with a stored copy: a change of layout requires a higher number.
pub const VERSION: u8 = 19;
/// Largest length of a frame's body (bytes): a long simulation with its snapshots fits.
pub const BODY_LIMIT: usize = 16 << 20;
/// Allowance for the data added to an outcome at each hop: slot to worker, worker to coordinator, coordinator
/// to journal (bytes). An outcome that passes one hop must fit through the next.
const ENVELOPE: usize = 64;
/// Length of a frame's header, which precedes the body (bytes).
pub const HEADER_BYTES: usize = 20;
const MAGIC: [u8; 2] = *b"HH";

/// Type of the body in a frame; a new kind gets a new number, numbers are never reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FrameKind {
    /// Body of the type [`crate::message::ToWorker`].
    ToWorker,
    /// Body of the type [`crate::message::FromWorker`].
    FromWorker,
    /// Body of the type [`crate::message::ToSlot`].
    ToSlot,
    /// Body of the type [`crate::message::FromSlot`].
    FromSlot,
}

impl FrameKind {
    /// All kinds of frames.
    pub const ALL: [Self; 4] = [
        Self::ToWorker,
        Self::FromWorker,
        Self::ToSlot,
        Self::FromSlot,
    ];

    /// Returns the number that stands for the kind in a frame's header.
    pub const fn number(self) -> u8 {
        match self {
            Self::ToWorker => 1,
            Self::FromWorker => 2,
            Self::ToSlot => 3,
            Self::FromSlot => 4,
        }
    }

    /// Returns the largest length of a body of this kind (bytes). Results from slots end up in the journal,
    /// with more data around them at each hop, so their limit is lower.
    pub const fn limit(self) -> usize {
        match self {
            Self::ToWorker | Self::ToSlot => BODY_LIMIT,
            Self::FromWorker => BODY_LIMIT - ENVELOPE,
            Self::FromSlot => BODY_LIMIT - 2 * ENVELOPE,
        }
    }
}

/// Reason why bytes are not a valid message.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum WireError {
    /// The frame is truncated.
    #[error("the frame is truncated: {found} of {expected} bytes were received")]
    Truncated {
        /// Number of bytes of the frame that were received.
        found: usize,
        /// Number of bytes that the frame must have according to its header.
        expected: usize,
    },
    /// The first two bytes are not the magic number `HH`.
    #[error("not a horsehead frame: it begins with {found:02x?}")]
    Magic {
        /// First two bytes of the frame.
        found: [u8; 2],
    },
    /// The peer uses another wire version.
    #[error(
        "wire version {found}, but this build speaks {VERSION}: use the same build on both ends"
    )]
    Version {
        /// Wire version of the peer.
        found: u8,
    },
    /// The kind of the frame is not the expected one.
    #[error("a frame of kind {found} was received where kind {expected} was expected")]
    Kind {
        /// Number of the frame kind stated in the header.
        found: u8,
        /// Number of the frame kind that the reader expects.
        expected: u8,
    },
    /// The body exceeds the length limit of its kind.
    #[error("a body of {bytes} bytes exceeds the limit of {limit}")]
    TooLong {
        /// Length of the body (bytes).
        bytes: usize,
        /// Largest permitted length of the body (bytes).
        limit: usize,
    },
    /// The checksum does not match the body.
    #[error(
        "the body is damaged: its checksum is {found:08x}, but the header states {expected:08x}"
    )]
    Checksum {
        /// Checksum computed from the body.
        found: u32,
        /// Checksum stated in the header.
        expected: u32,
    },
    /// Bytes remain after the decoded value.
    #[error("the message is too long for its type: {bytes} bytes remain after decoding")]
    Leftover {
        /// Number of bytes that remain after decoding.
        bytes: usize,
    },
    /// The value cannot be encoded, or the body cannot be decoded as the expected type.
    #[error("the message cannot be encoded or decoded: {reason}")]
    Malformed {
        /// Error message of the encoder or decoder.
        reason: String,
    },
}

/// Content of a frame whose header and checksum are valid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame<'a> {
    /// Run that the frame belongs to; 0 if the worker does not know the run yet.
    pub run: RunId,
    /// Body of the frame: the message, still encoded.
    pub body: &'a [u8],
}

/// Encodes a value without a frame, for content that is addressed by its hash.
///
/// # Errors
/// [`WireError::TooLong`] beyond [`BODY_LIMIT`]; [`WireError::Malformed`] if the value cannot be encoded.
pub fn encode<T: Serialize>(value: &T) -> Result<Vec<u8>, WireError> {
    let mut bytes = Vec::new();
    append(&mut bytes, value, BODY_LIMIT)?;
    Ok(bytes)
}

/// Decodes a value that consumes all of `bytes`.
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
/// Those of [`encode`], with the limit of the kind.
pub fn encode_frame<T: Serialize>(
    kind: FrameKind,
    run: RunId,
    value: &T,
) -> Result<Vec<u8>, WireError> {
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

/// Checks header and checksum of a frame and returns its body, still encoded.
///
/// # Errors
/// Any of [`WireError`] but [`WireError::Malformed`].
pub fn parse_frame(kind: FrameKind, frame: &[u8]) -> Result<Frame<'_>, WireError> {
    let (header, body) = frame
        .split_first_chunk::<HEADER_BYTES>()
        .ok_or(WireError::Truncated {
            found: frame.len(),
            expected: HEADER_BYTES,
        })?;
    let length = check_header(kind, header)?;
    match body.len() {
        found if found < length => Err(WireError::Truncated {
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

/// Checks header and checksum of a frame and decodes its body.
///
/// # Errors
/// Any of [`WireError`].
pub fn decode_frame<T: DeserializeOwned>(
    kind: FrameKind,
    frame: &[u8],
) -> Result<(RunId, T), WireError> {
    let opened = parse_frame(kind, frame)?;
    Ok((opened.run, decode(opened.body)?))
}

/// Returns the length of the body that follows a header on a stream (bytes).
///
/// # Errors
/// Those of [`parse_frame`] that concern the header.
pub fn body_length(kind: FrameKind, header: &[u8; HEADER_BYTES]) -> Result<usize, WireError> {
    check_header(kind, header)
}

fn check_header(kind: FrameKind, header: &[u8; HEADER_BYTES]) -> Result<usize, WireError> {
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
