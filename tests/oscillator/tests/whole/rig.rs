//! Test folder with a copy of the case and its synthetic records, and helpers that run the program on them.
use crate::foreign_terms;
use oscillator::{
    case_folder::{self, CROSSTALK, FRICTION_N, HIDDEN},
    effect::Effects,
    simulate::Values,
};
use serde_json::Value;
use std::{
    fs,
    io::Write as _,
    os::unix::fs::symlink,
    path::{Path, PathBuf},
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};
use tempfile::TempDir;

/// Path of the worker program.
const WORKER: &str = env!("CARGO_BIN_EXE_test-oscillator-worker");

/// Temporary folder with the case.
pub(crate) struct Rig(TempDir);

impl Rig {
    /// Creates the case with records that contain dry friction, which the case lacks.
    pub(crate) fn new() -> Self {
        let effects = Effects {
            friction_n: FRICTION_N,
            ..Effects::default()
        };
        Self::hiding(&HIDDEN, &effects, 0)
    }

    /// Creates the case with records in which the force disturbs the displacement reading.
    pub(crate) fn with_crosstalk() -> Self {
        let values = Values {
            crosstalk_mm_per_n: CROSSTALK,
            ..HIDDEN
        };
        Self::hiding(&values, &Effects::default(), 0)
    }

    /// Creates the case with records that contain no hidden effect.
    pub(crate) fn healthy() -> Self {
        Self::hiding(&HIDDEN, &Effects::default(), 0)
    }

    /// Creates the case with records of the given values and dry friction \[N\], and the noise seed `noise`;
    /// the friction is an unknown of the case.
    pub(crate) fn with_friction(values: &Values, friction_n: f64, noise: u64) -> Self {
        let effects = Effects {
            friction_n,
            ..Effects::default()
        };
        let rig = Self::hiding(values, &effects, noise);
        let file = rig.file("case/case.toml");
        let case = fs::read_to_string(&file).unwrap();
        let own = "\n[[effects]]\nid = \"dry_friction\"\n\
                   parameters = { force = { value = 1.0, unit = \"N\", search = [0.0, 10.0] } }\n";
        fs::write(&file, case + own).unwrap();
        rig
    }

    pub(crate) fn hiding(values: &Values, effects: &Effects, noise: u64) -> Self {
        let rig = Self(TempDir::new().unwrap());
        case_folder::write(&rig.file("case"), values, effects, noise).unwrap();
        symlink(WORKER, rig.file("worker")).unwrap();
        rig
    }

    /// Returns the path of a file in the test folder.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Returns the path of a file in the test folder as a command-line argument.
    pub(crate) fn path(&self, name: &str) -> String {
        self.file(name).display().to_string()
    }

    /// Returns the `horsehead` command with these arguments (`CASE` stands for the case folder) and two
    /// oscillator workers.
    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(Path::new(WORKER).with_file_name("horsehead"));
        let case = self.path("case");
        command
            .args(
                words
                    .iter()
                    .map(|word| if *word == "CASE" { &case } else { *word }),
            )
            .env("HORSEHEAD_WORKER", self.file("worker"))
            .env("HORSEHEAD_WORKERS", "2")
            .current_dir(self.0.path());
        command
    }

    /// Takes the worker program away from all further commands.
    pub(crate) fn without_worker(&self) {
        fs::remove_file(self.file("worker")).unwrap();
    }

    /// Starts an oscillator worker with one slot that dials the coordinator at an address until it answers, and
    /// ends some seconds after the run.
    pub(crate) fn worker(&self, address: &str) -> Child {
        Command::new(WORKER)
            .args(["--connect", address, "--slots", "1", "--idle-timeout", "5"])
            .current_dir(self.0.path())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap()
    }

    /// Runs a command, asserts success, checks that its output contains no pumping-unit terms, and returns
    /// its standard output.
    pub(crate) fn run(&self, words: &[&str]) -> String {
        let output = self.command(words).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {said}");
        let printed = String::from_utf8(output.stdout).unwrap();
        foreign_terms::check("standard error", &said);
        foreign_terms::check("standard output", &printed);
        printed
    }

    /// Runs a command, asserts that it is refused as bad input (exit code 2), and returns its standard error.
    pub(crate) fn refused(&self, words: &[&str]) -> String {
        let output = self.command(words).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words:?}: {said}");
        foreign_terms::check("standard error", &said);
        said
    }

    /// Runs a command with the given standard input; returns the JSON lines that it printed and its exit
    /// code.
    pub(crate) fn run_with_input(&self, words: &[&str], input: &str) -> (Vec<Value>, Option<i32>) {
        let mut command = self.command(words);
        let piped = command.stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = piped.stderr(Stdio::null()).spawn().unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(input.as_bytes())
            .unwrap();
        let output = child.wait_with_output().unwrap();
        let printed = String::from_utf8(output.stdout).unwrap();
        let lines = printed
            .lines()
            .map(|line| serde_json::from_str(line).unwrap());
        (lines.collect(), output.status.code())
    }

    /// Runs a command with `--output json` and returns the parsed object.
    pub(crate) fn json(&self, words: &[&str]) -> Value {
        serde_json::from_str(&self.run(&[words, &["--output", "json"]].concat())).unwrap()
    }

    /// Starts a command and kills it as soon as the journal in its run folder has `bytes` bytes.
    pub(crate) fn kill_at(&self, words: &[String], run: &Path, bytes: u64, limit: Duration) {
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let mut command = self.command(&words);
        let mut child = command
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let journal = run.join(journal::FILE);
        let begun = Instant::now();
        while fs::metadata(&journal).map_or(0, |file| file.len()) < bytes {
            assert!(
                begun.elapsed() < limit && child.try_wait().unwrap().is_none(),
                "no {bytes} bytes"
            );
            thread::sleep(Duration::from_millis(1));
        }
        child.kill().unwrap();
        child.wait().unwrap();
    }
}

/// Returns a JSON value as a number; NaN if it is none.
pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}
