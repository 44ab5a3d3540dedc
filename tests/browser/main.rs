//! Pages of the dashboard in a real browser: a run that goes on, is killed and resumed; finished runs; a folder of
//! runs; damaged, foreign and deleted ones.
#![expect(
    clippy::unwrap_used,
    reason = "helpers of a test suite: to panic is to fail the test"
)]
mod costs;
mod driver;
mod folder;
mod live;
mod stranger;

use serde_json::Value;
use std::{
    fs,
    io::{BufRead as _, BufReader},
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tests::process::{Process, coordinator_program};

/// Folder of a test's runs, with the worker program that its commands use.
struct Site {
    folder: tempfile::TempDir,
    worker: Option<PathBuf>,
}

impl Site {
    fn new(worker: Option<PathBuf>) -> Self {
        Self {
            folder: tempfile::tempdir().unwrap(),
            worker,
        }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Returns a `horsehead` command in the site's folder.
    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(coordinator_program());
        command
            .args(words)
            .current_dir(self.folder.path())
            .env("XDG_STATE_HOME", self.path("state"));
        // a test that looks at what is left makes it
        let temporary = self.path("temporary");
        if temporary.exists() {
            command.env("TMPDIR", temporary);
        }
        if let Some(worker) = &self.worker {
            command.env("HORSEHEAD_WORKER", worker);
        }
        command
    }

    fn run(&self, words: &[&str]) -> Output {
        let output = self.command(words).output().unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{words:?}: {errors}");
        output
    }

    /// Starts the dashboard of a run or a folder; returns its process and the address that it prints, with the
    /// token.
    fn dashboard(&self, path: &str) -> (Process, String) {
        let mut process = Process::logged(
            self.command(&["dashboard", path, "--port", "0"]),
            &self.path("dashboard.log"),
        );
        let mut url = String::new();
        let mut output = BufReader::new(process.output());
        output.read_line(&mut url).unwrap();
        (process, url.trim().to_owned())
    }

    fn result(&self, run: &str) -> Value {
        let file = self.path(run).join("result.json");
        serde_json::from_slice(&fs::read(file).unwrap()).unwrap()
    }
}

/// Returns the address of a page below the start page whose address the dashboard printed.
fn below(url: &str, path: &str) -> String {
    url.replace("/?", &format!("/{path}?"))
}

/// Returns the socket address in the address of a page.
fn socket_address(url: &str) -> &str {
    let rest = url.trim_start_matches("http://");
    rest.split('/').next().unwrap()
}

/// Returns the path of a picture that a test leaves for people to look at.
fn picture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("dashboard-{name}.png"))
}

/// Formats a number as reports do, to three significant digits.
fn shown(value: &Value) -> String {
    report::number::significant(value.as_f64().unwrap())
}
