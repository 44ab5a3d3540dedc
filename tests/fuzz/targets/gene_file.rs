//! Gene files as people write them: a value for every gene of the case, or refused in words.
#![no_main]
use coordinator::case::{Overrides, load, read_genes, write_genes};
use fuzz::file;
use libfuzzer_sys::fuzz_target;
use protocol::case::Case;
use std::{path::Path, sync::LazyLock};

static CASE: LazyLock<Case> = LazyLock::new(|| {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    load(&shipped, &Overrides::default()).expect("the shipped case")
});

fuzz_target!(|bytes: &[u8]| {
    match read_genes(&file("genes.toml", bytes), &CASE) {
        Ok(genes) => {
            let text = write_genes(&CASE, &genes, "fuzzing");
            let again = read_genes(&file("again.toml", text.as_bytes()), &CASE);
            let bits = |genes: &[f64]| genes.iter().map(|gene| gene.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&again.expect("what was written can be read")), bits(&genes));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
