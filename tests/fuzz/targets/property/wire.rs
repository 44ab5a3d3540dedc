//! Properties of the wire format: frames and their messages.
use protocol::{
    id::RunId,
    wire::{self, FrameKind, HEADER_BYTES},
};
use serde::{Serialize, de::DeserializeOwned};

/// Checks that the bytes are either accepted completely as a frame or rejected, and that the header alone
/// determines the body length.
pub fn is_a_frame_or_refused(bytes: &[u8]) {
    for kind in FrameKind::ALL {
        let opened = wire::parse_frame(kind, bytes);
        if let Some((header, rest)) = bytes.split_first_chunk::<HEADER_BYTES>() {
            let length = wire::body_length(kind, header);
            if let Ok(frame) = opened {
                assert_eq!(length, Ok(rest.len()));
                assert_eq!(frame.body, rest);
            } else if let Ok(length) = length {
                assert!(length <= wire::BODY_LIMIT);
            }
        } else {
            opened.expect_err("too short for a header");
        }
    }
}

/// Checks that bytes that decode also encode to the same bytes, so that each value has exactly one encoding.
pub fn is_canonical<T: Serialize + DeserializeOwned>(bytes: &[u8]) {
    if let Ok(value) = wire::decode::<T>(bytes) {
        let again = wire::encode(&value).expect("what was decoded can be encoded");
        assert_eq!(again, bytes, "two encodings of one value");
    }
}

/// Checks that a value has one encoding also inside a frame with a valid header and checksum.
pub fn is_canonical_in_frame<T: Serialize + DeserializeOwned>(kind: FrameKind, body: &[u8]) {
    is_canonical::<T>(body);
    let mut frame = wire::encode_frame(kind, RunId(7), &()).expect("an empty frame");
    frame.extend_from_slice(body);
    let length = u32::try_from(body.len()).expect("inputs are short");
    frame[12..16].copy_from_slice(&length.to_le_bytes());
    frame[16..20].copy_from_slice(&crc32(body).to_le_bytes());
    let opened = wire::parse_frame(kind, &frame).expect("a frame in order");
    assert_eq!(opened.body, body);
    assert_eq!(
        wire::decode_frame::<T>(kind, &frame).is_ok(),
        wire::decode::<T>(body).is_ok()
    );
}

/// Computes the CRC-32 (IEEE) bit by bit, independently of the code under test.
pub fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for byte in bytes {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = (crc >> 1) ^ (0xedb8_8320 & 0_u32.wrapping_sub(crc & 1));
        }
    }
    !crc
}
