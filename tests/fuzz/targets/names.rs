//! Fuzz target: parsers of bus keys, certificate owner names and addresses.
#![no_main]
use libfuzzer_sys::fuzz_target;
use link::locator::Locator;
use protocol::{
    key::{self, Lane},
    name,
};

fuzz_target!(|text: &str| {
    if let Some(worker) = key::worker_of(text) {
        // what was read names the same worker wherever it is written
        let again = key::from_worker(protocol::id::RunId(1), &worker, Lane::Data);
        assert_eq!(key::worker_of(&again), Some(worker));
    }
    if let Some((hash, chunk)) = key::blob_of(text) {
        let again = key::blob(protocol::id::RunId(1), hash, chunk);
        assert_eq!(key::blob_of(&again), Some((hash, chunk)));
    }
    if let Ok(()) = name::check_owner(text) {
        assert!(!text.contains(['/', '*', '$', '#', '?']));
    }
    match Locator::parse(text) {
        Ok(locator) => assert!(Locator::parse(&locator.to_string()).is_ok_and(|again| again == locator)),
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
