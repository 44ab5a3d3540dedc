//! Property tests with arbitrarily mutated case files: loading returns a case or an error and never panics,
//! and an error always names a file of the case and a remedy.
#![expect(
    clippy::unwrap_used,
    reason = "the helpers prepare folders; a test that cannot has failed"
)]
use case::{self, Overrides};
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use proptest::{prelude::*, test_runner::TestRunner};
use std::{
    fs,
    io::{Read, Write},
    path::{Path, PathBuf},
};
use tempfile::TempDir;

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb")
}

/// Name of the gzip-compressed record among the files that are mutated.
const PACKED: &str = "measured/test_5rpm.csv.gz";
const MESH: &str = "back_head/back_head.msh";
const FILES: [&str; 7] = [
    "case.toml",
    "measured/card_5rpm.csv",
    "measured/test_5rpm.toml",
    PACKED,
    "back_head/back_head_modes.json",
    "back_head/back_head_influence.csv",
    MESH,
];

/// Mutation of a file's bytes.
#[derive(Clone, Debug)]
enum Mutation {
    Flip { at: usize, mask: u8 },
    Cut { at: usize },
    Remove { at: usize, length: usize },
    Repeat { at: usize, length: usize },
    Insert { at: usize, text: &'static str },
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let words = prop::sample::select(vec![
        "-",
        "9",
        "e",
        "e99",
        ".",
        ",",
        "\n",
        "\"",
        "0",
        "nan",
        "inf",
        "-1",
        "99999999999999999999",
        "\u{0}",
        "µ",
        "[",
        "=",
        "#",
        "18446744073709551615 ",
    ]);
    prop_oneof![
        (0..1_000_000_usize, 1..=255_u8).prop_map(|(at, mask)| Mutation::Flip { at, mask }),
        (0..1_000_000_usize).prop_map(|at| Mutation::Cut { at }),
        (0..1_000_000_usize, 1..60_usize).prop_map(|(at, length)| Mutation::Remove { at, length }),
        (0..1_000_000_usize, 1..60_usize).prop_map(|(at, length)| Mutation::Repeat { at, length }),
        (0..1_000_000_usize, words).prop_map(|(at, text)| Mutation::Insert { at, text }),
    ]
}

fn apply(bytes: &mut Vec<u8>, mutation: &Mutation) {
    // places are given per million of the file
    let place = |at: usize, length: usize| at * length / 1_000_000;
    if bytes.is_empty() {
        return;
    }
    let size = bytes.len();
    match mutation {
        Mutation::Flip { at, mask } => bytes[place(*at, size)] ^= mask,
        Mutation::Cut { at } => bytes.truncate(place(*at, size)),
        Mutation::Remove { at, length } => {
            let from = place(*at, size);
            bytes.drain(from..(from + length).min(size));
        }
        Mutation::Repeat { at, length } => {
            let from = place(*at, size);
            let copy = bytes[from..(from + length).min(size)].to_vec();
            bytes.splice(from..from, copy);
        }
        Mutation::Insert { at, text } => {
            let from = place(*at, size);
            bytes.splice(from..from, text.bytes());
        }
    }
}

/// Copies the shipped case with one condition only, which is sufficient and faster; without `meshed`, it names no
/// mesh, whose 62,000 lines take longer to read than all other files.
fn lean_copy(meshed: bool) -> TempDir {
    let scratch = tempfile::tempdir().unwrap();
    for folder in ["measured", "back_head"] {
        fs::create_dir(scratch.path().join(folder)).unwrap();
    }
    for name in FILES {
        fs::copy(shipped().join(name), scratch.path().join(name)).unwrap();
    }
    let text = fs::read_to_string(scratch.path().join(FILES[0])).unwrap();
    let (first, rest) = text.split_once("[[conditions]]\nname = \"4rpm\"").unwrap();
    let (_, objective) = rest.split_once("[objective]").unwrap();
    let mut text = format!("{first}[objective]{objective}");
    if !meshed {
        text = text.replace("mesh_file =", "# mesh_file =");
    }
    fs::write(scratch.path().join(FILES[0]), text).unwrap();
    scratch
}

fn unpacked(bytes: &[u8]) -> Vec<u8> {
    let mut plain = Vec::new();
    GzDecoder::new(bytes).read_to_end(&mut plain).unwrap();
    plain
}

fn packed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
    encoder.write_all(bytes).unwrap();
    encoder.finish().unwrap()
}

/// Guard that restores the original content of a file when dropped, also after a panic, so that shrinking
/// starts from intact files.
struct Mutated {
    path: PathBuf,
    whole: Vec<u8>,
}

impl Drop for Mutated {
    fn drop(&mut self) {
        fs::write(&self.path, &self.whole).unwrap();
    }
}

#[test]
fn mutated_files_never_panic() {
    let config = ProptestConfig {
        cases: 250,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let strategy = (
        0..FILES.len(),
        // near the head of a file is where its structure is decided
        any::<bool>(),
        any::<bool>(),
        prop::collection::vec(mutation(), 1..4),
    );
    let copies = [false, true].map(lean_copy);
    let ran = TestRunner::new(config).run(&strategy, |(file, head, unpack, mutations)| {
        let copy = &copies[usize::from(FILES[file] == MESH)];
        let folder = copy.path().display().to_string();
        let path = copy.path().join(FILES[file]);
        let whole = fs::read(&path).unwrap();
        let mutated = Mutated { path, whole };
        let unpack = FILES[file] == PACKED && unpack;
        let mut bytes = if unpack {
            unpacked(&mutated.whole)
        } else {
            mutated.whole.clone()
        };
        let tail = if head {
            bytes.split_off(bytes.len().min(1500))
        } else {
            Vec::new()
        };
        for mutation in &mutations {
            apply(&mut bytes, mutation);
        }
        bytes.extend(tail);
        let bytes = if unpack { packed(&bytes) } else { bytes };
        fs::write(&mutated.path, bytes).unwrap();
        if let Err(error) = case::load(copy.path(), &Overrides::default()) {
            let message = error.to_string();
            prop_assert!(message.starts_with(&folder), "{message}");
            prop_assert!(message.contains("\nhelp: "), "{message}");
        }
        Ok(())
    });
    ran.unwrap();
}
