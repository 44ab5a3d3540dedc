//! A scratch folder with a case, a list of what may be started, and the program that is run on them.
use serde_json::Value;
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};
use tempfile::TempDir;

/// A scratch folder of one test.
pub(crate) struct Rig(TempDir);

impl Rig {
    pub(crate) fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    /// With a case that was shipped with the suite, its program allowed.
    pub(crate) fn of(case: &str) -> Self {
        let rig = Self::new();
        copy(&source("external").join(case), &rig.file("case"));
        rig.done(&["allow", "case"]);
        rig
    }

    /// With a case of one unknown whose program is a shell's; `model` are more lines of `[model]`, and the program
    /// leaves one number in `out.csv`.
    pub(crate) fn shell(program: &str, model: &str) -> Self {
        let rig = Self::new();
        rig.shell_case(program, model);
        rig.done(&["allow", "case"]);
        rig
    }

    /// Writes that case.
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

    /// A file of the folder.
    pub(crate) fn file(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The program with these words, in the folder, with two workers.
    pub(crate) fn run(&self, words: &[&str]) -> Output {
        let mut command = Command::new(tests::process::coordinator_program());
        command
            .args(words)
            .env("HORSEHEAD_ALLOW", self.file("allow.toml"))
            .env("HORSEHEAD_WORKER", tests::process::worker_program())
            .env("HORSEHEAD_WORKERS", "2")
            .env("TMPDIR", self.0.path())
            .current_dir(self.0.path());
        command.output().unwrap()
    }

    /// What a command printed that must succeed.
    pub(crate) fn done(&self, words: &[&str]) -> String {
        let output = self.run(words);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{words:?}: {errors}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// The object that a command printed.
    pub(crate) fn object(&self, words: &[&str]) -> Value {
        let words: Vec<&str> = words.iter().copied().chain(["--output", "json"]).collect();
        serde_json::from_str(&self.done(&words)).unwrap()
    }

    /// What a command complained of that must fail.
    pub(crate) fn refused(&self, words: &[&str]) -> String {
        let output = self.run(words);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{words:?}: {errors}");
        errors
    }

    /// Changes the entry of the list.
    pub(crate) fn limit(&self, from: &str, to: &str) {
        let path = self.file("allow.toml");
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{text}");
        fs::write(path, text.replace(from, to)).unwrap();
    }

    /// Folders of runs that were not removed.
    pub(crate) fn left(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names
            .filter(|name| name.starts_with("horsehead-") && !name.contains(".lock"))
            .collect()
    }

    /// Whether something is in a folder that an evaluation left.
    pub(crate) fn is_filled(&self, folder: &str) -> bool {
        fs::read_dir(self.file(folder)).is_ok_and(|mut entries| entries.next().is_some())
    }
}

/// A folder of the suites.
pub(crate) fn source(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

fn copy(from: &Path, to: &Path) {
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
