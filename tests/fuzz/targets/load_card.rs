//! Fuzz target: the reader of load cards.
#![no_main]
use fuzz::{FOLDER, property::file::is_a_card_or_refused};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| is_a_card_or_refused(&FOLDER, bytes));
