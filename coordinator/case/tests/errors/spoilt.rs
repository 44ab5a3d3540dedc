//! Temporary copy of the case shipped with the program, and functions that introduce faults into it.
use case::{self, CaseError, Overrides};
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use std::{
    fs,
    io::{Read, Write},
    path::{Path, PathBuf},
};
use tempfile::TempDir;

pub(super) fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb")
}

/// Temporary copy of the shipped case, to be modified by a test.
pub(super) struct Copy {
    pub(super) folder: TempDir,
}

impl Copy {
    pub(super) fn new() -> Self {
        let folder = TempDir::new().unwrap();
        for part in ["measured", "back_head"] {
            fs::create_dir(folder.path().join(part)).unwrap();
        }
        for file in [
            "case.toml",
            "measured/card_5rpm.csv",
            "measured/card_4rpm.csv",
            "measured/test_5rpm.csv.gz",
            "measured/test_5rpm.toml",
            "measured/test_4rpm.csv.gz",
            "measured/test_4rpm.toml",
            "back_head/back_head.msh",
            "back_head/back_head_modes.json",
            "back_head/back_head_influence.csv",
            TWINS,
        ] {
            fs::copy(shipped().join(file), folder.path().join(file)).unwrap();
        }
        Self { folder }
    }

    /// Copies the case without naming its mesh, whose 62,000 lines take longer to read than all other files.
    pub(super) fn without_mesh() -> Self {
        let copy = Self::new();
        copy.replace(TOML, "mesh_file =", "# mesh_file =");
        copy
    }

    pub(super) fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Replaces the first occurrence of a text in a file of the copy; fails if the file does not contain it.
    pub(super) fn replace(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
    }

    /// Removes the text from `from` up to, but not including, `until` from a file of the copy.
    pub(super) fn cut(&self, file: &str, from: &str, until: &str) {
        let text = fs::read_to_string(self.path(file)).unwrap();
        let (before, rest) = text.split_once(from).unwrap();
        let (_, after) = rest.split_once(until).unwrap();
        fs::write(self.path(file), format!("{before}{until}{after}")).unwrap();
    }

    /// Adds an `[[effects]]` table for `pivot_friction`, with the given further lines, to the copied case
    /// file.
    pub(super) fn effect(&self, lines: &str) {
        let added = format!("[[effects]]\nid = \"pivot_friction\"\n{lines}\n\n[objective]");
        self.replace(TOML, "[objective]", &added);
    }

    /// Rewrites every line of a CSV file of the copied case by a function; line 1 is the header.
    pub(super) fn lines(&self, file: &str, rewrite: impl Fn(usize, &str) -> Option<String>) {
        let path = self.path(file);
        let packed = Path::new(file).extension().is_some_and(|end| end == "gz");
        let mut text = String::new();
        if packed {
            let bytes = fs::read(&path).unwrap();
            GzDecoder::new(bytes.as_slice())
                .read_to_string(&mut text)
                .unwrap();
        } else {
            text = fs::read_to_string(&path).unwrap();
        }
        let numbered = text.lines().enumerate();
        let mut new: String = numbered
            .filter_map(|(at, line)| rewrite(at + 1, line))
            .collect::<Vec<_>>()
            .join("\n");
        new.push('\n');
        if packed {
            let mut encoder = GzEncoder::new(Vec::new(), Compression::fast());
            encoder.write_all(new.as_bytes()).unwrap();
            fs::write(path, encoder.finish().unwrap()).unwrap();
        } else {
            fs::write(path, new).unwrap();
        }
    }

    pub(super) fn error(&self) -> CaseError {
        case::load(self.folder.path(), &Overrides::default()).unwrap_err()
    }
}

/// Replaces one cell of a CSV line.
pub(super) fn cell(line: &str, column: usize, value: &str) -> String {
    let mut cells: Vec<&str> = line.split(',').collect();
    cells[column] = value;
    cells.join(",")
}

/// Multiplies the given columns of a CSV line by a factor; line 1, the header, is unchanged.
#[expect(
    clippy::unnecessary_wraps,
    reason = "the shape that rewriting lines asks for: none removes the line"
)]
pub(super) fn scaled(at: usize, line: &str, columns: &[usize], factor: f64) -> Option<String> {
    let mut text = line.to_owned();
    if at > 1 {
        for &column in columns {
            let value: f64 = line.split(',').nth(column).unwrap().parse().unwrap();
            text = cell(&text, column, &format!("{}", value * factor));
        }
    }
    Some(text)
}

pub(super) const TOML: &str = "case.toml";
pub(super) const CARD: &str = "measured/card_5rpm.csv";
pub(super) const RECORD: &str = "measured/test_5rpm.csv.gz";
pub(super) const SHEET: &str = "measured/test_5rpm.toml";
pub(super) const TWINS: &str = "back_head/back_head_twin.json";
pub(super) const MODES: &str = "back_head/back_head_modes.json";
pub(super) const INFLUENCE: &str = "back_head/back_head_influence.csv";
pub(super) const MESH: &str = "back_head/back_head.msh";

/// Fault of a case: name, function that introduces it, variant of [`CaseError`] that it gives, and what the message must
/// contain: file, field, values, names. Sentences are not compared.
pub(super) type Spoilt = (
    &'static str,
    fn(&Copy),
    &'static str,
    &'static [&'static str],
);

/// Checks that every fault of a table is named, in copies of the case that `copy` makes.
pub(super) fn assert_each_is_named(table: &[Spoilt], copy: fn() -> Copy) {
    let mut wrong = Vec::new();
    for (name, spoil, kind, expected) in table {
        let copy = copy();
        spoil(&copy);
        let error = copy.error();
        let debug = format!("{error:?}");
        let found = debug.split([' ', '(']).next().unwrap_or_default();
        if found != *kind {
            wrong.push(format!("{name}: a {found}, not a {kind}: {error}"));
        }
        let message = error.to_string();
        let help = message.lines().last().unwrap_or_default();
        if help.len() < 15 || !help.starts_with("help: ") {
            wrong.push(format!("{name}: no help in\n{message}"));
        }
        for part in *expected {
            if !message.contains(part) {
                wrong.push(format!("{name}: no `{part}` in\n{message}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
