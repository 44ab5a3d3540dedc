//! Fuzz target: bodies of [`ToWorker`] and [`ToSlot`] messages, which nest the same types.
#![no_main]
use fuzz::property::wire::is_canonical_in_frame;
use libfuzzer_sys::fuzz_target;
use protocol::{
    message::{ToSlot, ToWorker},
    wire::Kind,
};

fuzz_target!(|body: &[u8]| {
    is_canonical_in_frame::<ToWorker>(Kind::ToWorker, body);
    is_canonical_in_frame::<ToSlot>(Kind::ToSlot, body);
});
