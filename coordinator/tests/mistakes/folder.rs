//! Temporary folder with a copy of the shipped case, in which mistakes are made.
use flate2::{Compression, read::GzDecoder, write::GzEncoder};
use std::{
    fs,
    io::{Read as _, Write as _},
    path::{Path, PathBuf},
    process::Command,
};
use tempfile::TempDir;

/// Temporary folder with a copy of the shipped case; commands run in it.
pub(crate) struct TestFolder {
    folder: TempDir,
}

impl TestFolder {
    pub(crate) fn new() -> Self {
        let desk = Self {
            folder: TempDir::new().unwrap(),
        };
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb");
        for part in ["measured", "back_head"] {
            fs::create_dir_all(desk.path("case").join(part)).unwrap();
            for file in fs::read_dir(shipped.join(part)).unwrap() {
                let file = file.unwrap();
                let to = desk.path("case").join(part).join(file.file_name());
                fs::copy(file.path(), to).unwrap();
            }
        }
        for file in ["case.toml", "recommended.toml", "table3_optimised.toml"] {
            fs::copy(shipped.join(file), desk.path("case").join(file)).unwrap();
        }
        desk
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Replaces the first occurrence of a text in a file. Panics if the file does not contain the text.
    pub(crate) fn replace(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
    }

    pub(crate) fn write(&self, file: &str, text: &str) {
        fs::write(self.path(file), text).unwrap();
    }

    /// Rewrites the measured record row by row: `rewrite` gets the row number (0 for the header) and the
    /// cells of the row.
    pub(crate) fn record(&self, rewrite: impl Fn(usize, &mut Vec<String>)) {
        let path = self.path("case/measured/test_5rpm.csv.gz");
        let mut text = String::new();
        GzDecoder::new(fs::File::open(&path).unwrap())
            .read_to_string(&mut text)
            .unwrap();
        let mut encoder = GzEncoder::new(fs::File::create(&path).unwrap(), Compression::fast());
        for (row, line) in text.lines().enumerate() {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            rewrite(row, &mut cells);
            writeln!(encoder, "{}", cells.join(",")).unwrap();
        }
        encoder.finish().unwrap();
    }

    /// Rewrites the load card: `rewrite` returns the cells of a row, given its number and all rows.
    pub(crate) fn card(&self, rewrite: impl Fn(usize, &[Vec<String>]) -> (String, String)) {
        let path = self.path("case/measured/card_5rpm.csv");
        let text = fs::read_to_string(&path).unwrap();
        let (header, rest) = text.split_once('\n').unwrap();
        let cells = |line: &str| line.split(',').map(str::to_owned).collect();
        let rows: Vec<Vec<String>> = rest.lines().map(cells).collect();
        let lines = (0..rows.len()).map(|row| {
            let (turn, load) = rewrite(row, &rows);
            format!("{turn},{load}\n")
        });
        fs::write(&path, format!("{header}\n{}", lines.collect::<String>())).unwrap();
    }

    /// Adds an effect, given as lines of TOML, to the test case.
    pub(crate) fn effect(&self, lines: &str) {
        self.replace(
            "case/case.toml",
            "[objective]",
            &format!("{lines}\n\n[objective]"),
        );
    }

    /// Runs a command and returns its exit code and its output (stdout followed by stderr).
    pub(crate) fn run(&self, command: &str) -> (i32, String) {
        let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
            .args(command.split(' '))
            .current_dir(self.folder.path())
            .env("HORSEHEAD_ALLOW", self.path("allow.toml"))
            .output()
            .unwrap();
        let said = [output.stdout, output.stderr].concat();
        let said = String::from_utf8_lossy(&said).into_owned();
        (output.status.code().unwrap(), said)
    }
}

/// One mistake: its name, the preparation of the folder, the command, the expected exit code, and texts that
/// the output must contain.
pub(crate) type Mistake = (
    &'static str,
    fn(&TestFolder),
    &'static str,
    i32,
    &'static [&'static str],
);
