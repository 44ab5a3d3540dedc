//! Whatever bytes stand in the files of a case: loading ends in a case or in an error, never in a
//! panic, and an error always names a file of the case and a remedy.
use coordinator::case::{self, Overrides};
use proptest::prelude::*;
use std::{
    fs,
    io::Write,
    path::{Path, PathBuf},
};

fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

/// The one that is compressed.
const PACKED: &str = "measured/test_5rpm.csv.gz";
const FILES: [&str; 7] = [
    "case.toml",
    "measured/card_5rpm.csv",
    "measured/test_5rpm.toml",
    PACKED,
    "back_head/back_head_modes.json",
    "back_head/back_head_influence.csv",
    "back_head/back_head.msh",
];

/// One way to change a run of bytes.
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

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn mutated_files_never_panic(
        file in 0..FILES.len(),
        // near the head of a file is where its structure is decided
        head in any::<bool>(),
        unpack in any::<bool>(),
        mutations in prop::collection::vec(mutation(), 1..4),
    ) {
        let scratch = tempfile::tempdir().unwrap();
        for folder in ["measured", "back_head"] {
            fs::create_dir(scratch.path().join(folder)).unwrap();
        }
        for name in FILES {
            fs::copy(shipped().join(name), scratch.path().join(name)).unwrap();
        }
        // one condition suffices, and is quicker
        let text = fs::read_to_string(scratch.path().join(FILES[0])).unwrap();
        let (first, rest) = text.split_once("[[conditions]]\nname = \"4rpm\"").unwrap();
        let (_, objective) = rest.split_once("[objective]").unwrap();
        fs::write(scratch.path().join(FILES[0]), format!("{first}[objective]{objective}")).unwrap();

        let path = scratch.path().join(FILES[file]);
        let mut bytes = fs::read(&path).unwrap();
        let packed = FILES[file] == PACKED && unpack;
        if packed {
            let mut plain = Vec::new();
            std::io::Read::read_to_end(&mut flate2::read::GzDecoder::new(bytes.as_slice()), &mut plain).unwrap();
            bytes = plain;
        }
        let tail = if head { bytes.split_off(bytes.len().min(1500)) } else { Vec::new() };
        for mutation in &mutations {
            apply(&mut bytes, mutation);
        }
        bytes.extend(tail);
        if packed {
            let mut encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
            encoder.write_all(&bytes).unwrap();
            bytes = encoder.finish().unwrap();
        }
        fs::write(&path, bytes).unwrap();
        if let Err(error) = case::load(scratch.path(), &Overrides::default()) {
            let message = error.to_string();
            prop_assert!(message.starts_with(&scratch.path().display().to_string()), "{message}");
            prop_assert!(message.contains("\nhelp: "), "{message}");
        }
    }
}
