//! Fuzz target: encoded cases, which workers fetch by hash.
#![no_main]
use fuzz::property::wire::is_canonical;
use libfuzzer_sys::fuzz_target;
use protocol::case::Case;

fuzz_target!(|bytes: &[u8]| is_canonical::<Case>(bytes));
