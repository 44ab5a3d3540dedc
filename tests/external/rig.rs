//! Scratch folder for a test, with a case, a list of allowed programs, and helpers that run the coordinator.
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

pub(crate) struct Rig(TempDir);

impl Rig {
    pub(crate) fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// Creates a test folder with a copy of a case of this suite, whose program is allowed to run.
    pub(crate) fn of(case: &str) -> Self {
        let rig = Self::new();
        copy(&source("external").join(case), &rig.file("case"));
        rig.done(&["allow", "case"]);
        rig
    }

    /// Creates a test folder with a case of one unknown whose model is a shell script that writes `out.csv`.
    /// `model` holds additional lines of `[model]`.
    pub(crate) fn shell(program: &str, model: &str) -> Self {
        let rig = Self::new();
        rig.shell_case(program, model);
        rig.done(&["allow", "case"]);
        rig
    }

    /// Writes the case of one unknown with a shell script as its model, without allowing its program.
    pub(crate) fn shell_case(&self, program: &str, model: &str) {
        let folder = self.file("case");
        fs::create_dir_all(&folder).unwrap();
        fs::write(folder.join("model.sh"), program).unwrap();
        fs::write(folder.join("in.tpl"), "x {x}\n").unwrap();
        fs::write(folder.join("record.csv"), "time,y\n0,1\n1,2\n2,4\n").unwrap();
        let case = format!(
            "name = \"shell\"\n[model]\nkind = \"command\"\nentry = \"shell\"\n\
             command = [\"/bin/sh\", \"model.sh\"]\nfiles = [\"model.sh\"]\ndeadline_s = 20.0\n\
             inputs = [{{ file = \"in.txt\", braces = \"in.tpl\" }}]\n\
             outputs = [{{ file = \"out.csv\" }}]\n{model}\n\
             [[unknowns]]\nname = \"x\"\nunit = \"1\"\nscale = \"linear\"\nstart = 1.0\nlower = 0.0\nupper = 2.0\n\
             [[conditions]]\nname = \"only\"\n\
             [[channels]]\nname = \"y\"\nunit = \"1\"\ncondition = \"only\"\n\
             abscissa = {{ name = \"time\", unit = \"s\" }}\nnoise = 0.1\n\
             record = {{ file = \"record.csv\", at = \"time\", column = \"y\" }}\n\
             source = {{ file = \"out.csv\", column = \"y\" }}\n\
             [objective]\ncondition = \"only\"\nterms = [{{ channel = \"y\", weight = 1.0 }}]\noffset = \"fixed\"\n"
        );
        fs::write(folder.join("case.toml"), case).unwrap();
    }

    /// Returns the path of a file in the test folder.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Runs the coordinator with these arguments in the test folder, with two workers.
    pub(crate) fn run(&self, words: &[&str]) -> Output {
        self.command(words).output().unwrap()
    }

    /// Returns a command that runs the coordinator as [`Self::run`].
    pub(crate) fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new(tests::process::coordinator_program());
        command
            .args(words)
            .env("HORSEHEAD_ALLOW", self.file("allow.toml"))
            .env("HORSEHEAD_WORKER", tests::process::worker_program())
            .env("HORSEHEAD_WORKERS", "2")
            .env("TMPDIR", self.0.path())
            .current_dir(self.0.path());
        command
    }

    /// Runs a coordinator command, asserts success, and returns its standard output.
    pub(crate) fn done(&self, words: &[&str]) -> String {
        let output = self.run(words);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// Runs a coordinator command with `--output json` and returns the parsed object.
    pub(crate) fn object(&self, words: &[&str]) -> Value {
        let words: Vec<&str> = words.iter().copied().chain(["--output", "json"]).collect();
        serde_json::from_str(&self.done(&words)).unwrap()
    }

    /// Runs a coordinator command, asserts failure, and returns its standard error.
    pub(crate) fn refused(&self, words: &[&str]) -> String {
        let output = self.run(words);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{words:?}: {errors}");
        errors
    }

    /// Replaces text in the list of allowed programs, for example to change a limit.
    pub(crate) fn limit(&self, from: &str, to: &str) {
        let path = self.file("allow.toml");
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{text}");
        fs::write(path, text.replace(from, to)).unwrap();
    }

    /// Returns the paths, in the test folder, of evaluations' temporary folders that were not removed.
    pub(crate) fn left(&self) -> Vec<String> {
        let own = format!("horsehead-{}", rustix::process::geteuid().as_raw());
        let entries = fs::read_dir(self.file(&own)).into_iter().flatten();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let left = names.filter(|name| !name.contains(".lock"));
        left.map(|name| format!("{own}/{name}")).collect()
    }

    /// Returns whether a folder contains files left by an evaluation.
    pub(crate) fn is_filled(&self, folder: &str) -> bool {
        fs::read_dir(self.file(folder)).is_ok_and(|mut entries| entries.next().is_some())
    }
}

/// Returns the path of a source folder of this test crate.
pub(crate) fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

pub(crate) fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let entry = entry.unwrap();
        let (path, place) = (entry.path(), to.join(entry.file_name()));
        if path.is_dir() {
            copy(&path, &place);
        } else {
            fs::copy(path, place).unwrap();
        }
    }
}
