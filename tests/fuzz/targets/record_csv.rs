//! Fuzz target: the reader of gauge records.
#![no_main]
use fuzz::property::file::are_samples_or_refused;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| are_samples_or_refused(bytes));
