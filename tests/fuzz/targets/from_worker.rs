//! Fuzz target: bodies of [`FromWorker`] and [`FromSlot`] messages, which nest the same types.
#![no_main]
use fuzz::property::wire::is_canonical_in_frame;
use libfuzzer_sys::fuzz_target;
use protocol::{
    message::{FromSlot, FromWorker},
    wire::Kind,
};

fuzz_target!(|body: &[u8]| {
    is_canonical_in_frame::<FromWorker>(Kind::FromWorker, body);
    is_canonical_in_frame::<FromSlot>(Kind::FromSlot, body);
});
