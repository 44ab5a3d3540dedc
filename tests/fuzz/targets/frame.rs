//! Fuzz target: the frame decoder on arbitrary bytes.
#![no_main]
use fuzz::property::wire::is_a_frame_or_refused;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| is_a_frame_or_refused(bytes));
