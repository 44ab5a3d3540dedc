//! Temporary copy of the shipped case with its raw files and without its records.
use flate2::read::GzDecoder;
use std::{
    fs,
    io::Read as _,
    path::{Path, PathBuf},
    process::Command,
};
use tempfile::TempDir;

/// Folder in which `case` is the shipped case before any import.
pub(crate) struct ImportFolder {
    folder: TempDir,
}

/// Returns the folder of the shipped case.
pub(crate) fn shipped() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../cases/cyjs10-5-37hb")
}

impl ImportFolder {
    pub(crate) fn new() -> Self {
        let copy = Self {
            folder: TempDir::new().unwrap(),
        };
        for part in ["raw", "back_head"] {
            fs::create_dir_all(copy.path("case").join(part)).unwrap();
            for file in fs::read_dir(shipped().join(part)).unwrap() {
                let file = file.unwrap();
                fs::copy(
                    file.path(),
                    copy.path("case").join(part).join(file.file_name()),
                )
                .unwrap();
            }
        }
        fs::copy(shipped().join("case.toml"), copy.path("case/case.toml")).unwrap();
        copy
    }

    pub(crate) fn path(&self, file: &str) -> PathBuf {
        self.folder.path().join(file)
    }

    /// Returns the bytes of all raw files.
    pub(crate) fn raw_bytes(&self) -> Vec<Vec<u8>> {
        let mut files: Vec<PathBuf> = fs::read_dir(self.path("case/raw"))
            .unwrap()
            .map(|file| file.unwrap().path())
            .collect();
        files.sort();
        files.iter().map(|file| fs::read(file).unwrap()).collect()
    }

    /// Returns the lines of a gzipped raw file, in Latin-1.
    pub(crate) fn raw_lines(&self, name: &str) -> Vec<String> {
        let mut bytes = Vec::new();
        let file = fs::File::open(self.path("case/raw").join(name)).unwrap();
        GzDecoder::new(file).read_to_end(&mut bytes).unwrap();
        let text: String = bytes.iter().map(|byte| char::from(*byte)).collect();
        text.lines().map(str::to_owned).collect()
    }

    /// Writes lines as a raw file in Latin-1.
    pub(crate) fn write_raw(&self, name: &str, lines: &[String]) {
        let text = lines.join("\r\n") + "\r\n";
        let bytes: Vec<u8> = text
            .chars()
            .map(|sign| u8::try_from(sign).unwrap())
            .collect();
        fs::write(self.path("case/raw").join(name), bytes).unwrap();
    }

    /// Replaces the first occurrence of a text in a file. Panics if the file does not contain it.
    pub(crate) fn replace(&self, file: &str, from: &str, to: &str) {
        let text = fs::read_to_string(self.path(file)).unwrap();
        assert!(text.contains(from), "{file} has no `{from}`:\n{text}");
        fs::write(self.path(file), text.replacen(from, to, 1)).unwrap();
    }

    /// Runs a command and returns its exit code and its output (stdout followed by stderr).
    pub(crate) fn run(&self, command: &str) -> (i32, String) {
        let output = Command::new(env!("CARGO_BIN_EXE_horsehead"))
            .args(command.split(' '))
            .current_dir(self.folder.path())
            .output()
            .unwrap();
        let said = [output.stdout, output.stderr].concat();
        (
            output.status.code().unwrap(),
            String::from_utf8_lossy(&said).into_owned(),
        )
    }

    /// Imports the raw files of a condition as the manual says: proposal, the angle's zero, import.
    pub(crate) fn import(&self, speed: &str) {
        let import = format!(
            "record import case/raw/strain_{speed}.csv.gz case/raw/card_{speed}.dyn --case case --condition {speed}"
        );
        let (code, said) = self.run(&import);
        assert_eq!(code, 2, "{said}");
        assert!(said.contains("angle.uncertainty_deg"), "{said}");
        self.state_zero(&format!("case/measured/test_{speed}.import.toml"));
        let (code, said) = self.run(&import);
        assert_eq!(code, 0, "{said}");
    }

    /// States the angle's zero in a proposed mapping.
    pub(crate) fn state_zero(&self, mapping: &str) {
        let path = self.path(mapping);
        let text = fs::read_to_string(&path).unwrap();
        let text = text
            .replace(
                "# bottom_dead_centre_deg = 0.0 ",
                "bottom_dead_centre_deg = 37.4 ",
            )
            .replace("# pulse_deg = 0.0 ", "pulse_deg = 0.0 ")
            .replace("# uncertainty_deg = 0.1 ", "uncertainty_deg = 0.06 ");
        fs::write(path, text).unwrap();
    }
}
