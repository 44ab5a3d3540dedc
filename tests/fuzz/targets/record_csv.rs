//! The samples of a gauge record: counted, or refused in words.
#![no_main]
use libfuzzer_sys::fuzz_target;
use std::path::Path;

fuzz_target!(|bytes: &[u8]| {
    match coordinator::case::count_samples(Path::new("record.csv"), bytes) {
        Ok(samples) => assert!(samples >= 4),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
