//! Fuzz target: the reader of `case.toml`.
#![no_main]
use fuzz::{FOLDER, property::file::is_a_case_or_refused};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| is_a_case_or_refused(&FOLDER, bytes));
