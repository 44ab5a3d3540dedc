//! Bytes as they arrive: a frame is taken whole or refused, and its header alone gives the length.
#![no_main]
use libfuzzer_sys::fuzz_target;
use protocol::wire::{self, HEADER_BYTES, Kind};

fuzz_target!(|bytes: &[u8]| {
    for kind in Kind::ALL {
        let opened = wire::open(kind, bytes);
        if let Some((header, rest)) = bytes.split_first_chunk::<HEADER_BYTES>() {
            let length = wire::body_length(kind, header);
            if let Ok(frame) = opened {
                assert_eq!(length, Ok(rest.len()));
                assert_eq!(frame.body, rest);
            } else if let Ok(length) = length {
                assert!(length <= wire::BODY_LIMIT);
            }
        } else {
            assert!(opened.is_err());
        }
    }
});
