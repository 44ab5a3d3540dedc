//! Fuzz target: the journal reader on intact entries, damaged entries and random bytes between them.
//!
//! The first byte of each segment decides whether its bytes become an entry with mark and checksum; the
//! second byte is the length.
#![no_main]
use fuzz::{
    FOLDER,
    property::file::{is_read_or_reported, record},
};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let mut journal = Vec::new();
    let mut rest = bytes;
    while let [how, length, tail @ ..] = rest {
        let (body, behind) = tail.split_at(tail.len().min(usize::from(*length)));
        rest = behind;
        if how % 2 == 0 {
            journal.extend(record(body));
        } else {
            journal.extend_from_slice(body);
        }
    }
    is_read_or_reported(&FOLDER, &journal);
});
