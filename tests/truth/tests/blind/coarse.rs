//! Coarsely discretised copy of the shipped case, and sets of records made for it.
use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

fn truth(arguments: &[&str]) -> String {
    run(Command::new(env!("CARGO_BIN_EXE_truth")).args(arguments))
}

pub(crate) fn run(command: &mut Command) -> String {
    let out = command
        .stderr(Stdio::inherit())
        .output()
        .expect("it starts");
    assert!(out.status.success(), "{command:?} fails");
    String::from_utf8(out.stdout).expect("text")
}

/// Returns the path of the program under test, next to `truth` as `cargo test --workspace` builds it with its
/// worker.
fn horsehead() -> PathBuf {
    let program = Path::new(env!("CARGO_BIN_EXE_truth")).with_file_name("horsehead");
    let shown = program.display();
    assert!(program.is_file(), "`cargo build` makes {shown}");
    program
}

/// Copies the shipped case, with fewer and longer cylinders, into a folder.
pub(crate) fn coarse_case(folder: &Path) -> PathBuf {
    let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/cyjs10-5-37hb");
    let case = folder.join("case");
    for part in ["back_head", "measured"] {
        fs::create_dir_all(case.join(part)).expect("a folder");
        for file in fs::read_dir(shipped.join(part)).expect("the shipped case") {
            let file = file.expect("an entry");
            let to = case.join(part).join(file.file_name());
            fs::copy(file.path(), to).expect("a copy");
        }
    }
    let mut text = fs::read_to_string(shipped.join("case.toml")).expect("the case file");
    for (key, fine, coarse) in [
        ("cylinder_length_m", "0.050", "0.150"),
        ("back_cylinders", "72", "24"),
        ("front_cylinders", "114", "38"),
    ] {
        let (from, to) = (format!("{key} = {fine}"), format!("{key} = {coarse}"));
        assert_eq!(text.matches(&from).count(), 1, "{from}");
        text = text.replace(&from, &to);
    }
    fs::write(case.join("case.toml"), text).expect("the case file");
    case
}

/// Coefficients from which the diagnosis starts: the optimised column of the paper's Table 3, with the axial
/// damping of a steel rope.
const START: &str = r#"
kb1  = { value = 7.81e8, unit = "N/m" }
kb23 = { value = 2.26e8, unit = "N/m" }
kb4  = { value = 204.0, unit = "N.m/deg" }
kb56 = { value = 308.0, unit = "N.m/deg" }
cb1  = { value = 1.0e6, unit = "N.s/m" }
cb23 = { value = 4287.0, unit = "N.s/m" }
cb4  = { value = 45.0, unit = "N.m.s/deg" }
cb56 = { value = 56.0, unit = "N.m.s/deg" }
kc   = { value = 4.01e8, unit = "N/m^1.5" }
cc   = { value = 1.02e3, unit = "N.s/m" }
"#;

/// Candidate effects of the diagnosis: pivot friction, one that resembles it, and others of load, crank and
/// gauges.
const CONSIDERED: [&str; 6] = [
    "pivot_friction",
    "rope_bending_loss",
    "crank_speed_ripple",
    "card_time_shift",
    "load_offset",
    "gauge_drift",
];

/// Returns the `--without` argument that excludes every named effect of the library except [`CONSIDERED`].
fn without() -> String {
    let library = worker::SIMULATORS[0].effects().into_iter();
    let named = library
        .filter(|effect| !effect.generic)
        .map(|effect| effect.id);
    let others = named.filter(|id| !CONSIDERED.contains(&id.as_str()));
    others.collect::<Vec<_>>().join(",")
}

/// Arguments of `truth make` for a set that hides saddle friction of five times its typical size.
pub(crate) const FRICTION: [&str; 10] = [
    "--seed",
    "2",
    "--stratum",
    "single",
    "--effect",
    "pivot_friction",
    "--times",
    "5",
    "--noise",
    "4",
];

/// Set of records in a scratch folder, with a copy of the case and its answer file, which is sealed by a hash
/// commitment.
pub(crate) struct Trial {
    scratch: tempfile::TempDir,
    pub(crate) set: PathBuf,
    /// Commitment to the hidden effects, as printed by `truth make`: hash of the answer file, which `truth
    /// open` checks.
    commitment: String,
}

impl Trial {
    /// Makes a set of records with the given arguments of `truth make`.
    pub(crate) fn make(arguments: &[&str]) -> Self {
        let scratch = tempfile::tempdir().expect("a folder");
        coarse_case(scratch.path());
        fs::write(scratch.path().join("start.toml"), START).expect("a file");
        let at = |name: &str| scratch.path().join(name).display().to_string();
        let (case, sets, answers) = (at("case"), at("sets"), at("answers.json"));
        let make = [
            "make",
            "--case",
            &case,
            "--out",
            &sets,
            "--answers",
            &answers,
        ];
        let said = truth(&[&make, &["--coarse"][..], arguments].concat());
        Self {
            set: PathBuf::from(said.lines().next().expect("a folder's name")),
            commitment: said
                .split_whitespace()
                .last()
                .expect("a commitment")
                .to_owned(),
            scratch,
        }
    }

    /// Returns the path of a file `name` in the scratch folder.
    pub(crate) fn at(&self, name: &str) -> PathBuf {
        self.scratch.path().join(name)
    }

    /// Returns a command of the program under test that runs in the scratch folder.
    pub(crate) fn horsehead(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(horsehead());
        command.args(arguments).current_dir(self.scratch.path());
        command
    }

    /// Returns the command that diagnoses the set in one round.
    pub(crate) fn diagnose(&self) -> Command {
        let mut command = self.horsehead(&["diagnose", "case", "--run", "run", "--rounds", "1"]);
        command.args(["--genes", "start.toml", "--output", "json"]);
        command
            .args(["--without", &without(), "--measured"])
            .arg(&self.set);
        command
    }
    /// Runs `truth open`, which reveals the hidden effects and scores a verdict; returns the score table.
    /// Also asserts that a modified answer file is refused.
    pub(crate) fn open(&self, verdict: &str) -> String {
        let verdicts = self.at("verdicts");
        fs::create_dir(&verdicts).expect("a folder");
        let name = self.set.file_name().expect("a name").display();
        fs::write(verdicts.join(format!("{name}.json")), verdict).expect("a file");
        let (answers, verdicts) = (self.at("answers.json"), verdicts.display().to_string());
        let shown = answers.display().to_string();
        let open = ["open", "--answers", &shown, "--verdicts", &verdicts];
        let open = [&open[..], &["--commitment", &self.commitment]].concat();
        let table = truth(&open);
        let sealed = fs::read_to_string(&answers).expect("answers");
        fs::write(&answers, sealed.replace("\"seed\"", " \"seed\"")).expect("a file");
        let forged = Command::new(env!("CARGO_BIN_EXE_truth"))
            .args(open)
            .output();
        assert!(!forged.expect("it starts").status.success());
        table
    }
}
