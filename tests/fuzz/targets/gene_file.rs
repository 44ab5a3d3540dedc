//! Fuzz target: the reader of gene files.
#![no_main]
use case::{Overrides, load};
use fuzz::{FOLDER, property::file::are_genes_or_refused};
use libfuzzer_sys::fuzz_target;
use protocol::case::Case;
use std::{path::Path, sync::LazyLock};

static CASE: LazyLock<Case> = LazyLock::new(|| {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    load(&shipped, &Overrides::default()).expect("the shipped case")
});

fuzz_target!(|bytes: &[u8]| are_genes_or_refused(&FOLDER, &CASE, bytes));
