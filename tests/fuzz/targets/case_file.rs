//! `case.toml` as people write it: a case or an error that names a file and a remedy.
#![no_main]
use fuzz::file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let path = file("case.toml", bytes);
    let folder = path.parent().expect("a folder");
    if let Err(error) = coordinator::case::check(folder) {
        assert!(!error.to_string().is_empty());
    }
});
