//! List of the programs that a machine allows to be started for the cases of others. The list is a file that
//! neither cases nor coordinators ever write.
//!
//! ```toml
//! [entry.decay]
//! program = "/usr/bin/python3"
//! arguments = ["model.py"]
//! files = "5f1c.."                # digest of the case's files that were reviewed; without it any files
//! cores = 1                       # hardware threads that one run occupies
//! at_once = 2                     # maximum number of simultaneous runs [as many as fit]
//! wall_s = 3600.0                 # maximum wall time of a run
//! memory_mib = 8192               # address space of each process, 0 for no limit
//! output_mib = 256                # maximum that one run may write
//! folder = "/scratch"             # parent of the runs' folders [the system's folder for temporary files]
//! environment = { OMP_NUM_THREADS = "1" }   # in addition to PATH, HOME, LANG, LC_ALL, TZ, TMPDIR
//! pass = ["LM_LICENSE_FILE"]      # further variables inherited from the worker
//! version = ["/usr/bin/python3", "--version"]   # machines with different output do not work together
//! keep_failed = false             # whether the folder of a failed run is kept
//! ```
use crate::Problem;
use serde::{Deserialize, Serialize};
use std::{
    collections::BTreeMap,
    env, fs,
    io::ErrorKind,
    path::{Path, PathBuf},
    thread,
};

/// Environment variable that overrides the path of the list of allowed programs.
pub const VARIABLE: &str = "HORSEHEAD_ALLOW";

/// List of the programs that a machine allows to be started.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Allowed {
    /// Allowed programs, by the entry name under which cases refer to them.
    #[serde(default)]
    pub entry: BTreeMap<String, AllowEntry>,
}

/// Allowed program with its arguments, and the limits of its runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AllowEntry {
    /// Path of the program: absolute, or relative to the folder of a run.
    pub program: PathBuf,
    /// Arguments with which the program is started.
    #[serde(default)]
    pub arguments: Vec<String>,
    /// Digest of the case's files that were reviewed; without it any files are accepted.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub files: Option<String>,
    /// Number of hardware threads that one run of the program occupies.
    #[serde(default = "one")]
    pub cores: u32,
    /// Maximum number of simultaneous runs; without it as many as the cores allow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_once: Option<u32>,
    /// Maximum wall time of a run of the program (s).
    #[serde(default = "hour")]
    pub wall_s: f64,
    /// Address-space limit of each process (MiB); 0 for no limit.
    #[serde(default = "eight_gib")]
    pub memory_mib: u64,
    /// Maximum volume that one run may write, including its outputs (MiB); 0 for no limit.
    #[serde(default = "quarter_gib")]
    pub output_mib: u64,
    /// Parent folder of the runs' folders; without it the system's folder for temporary files.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub folder: Option<PathBuf>,
    /// Environment variables that are set for the program.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub environment: BTreeMap<String, String>,
    /// Names of environment variables that are inherited from the worker.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pass: Vec<String>,
    /// Command that prints the program's version; machines with different output do not work together.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub version: Vec<String>,
    /// Whether the folder of a failed run is kept.
    #[serde(default)]
    pub keep_failed: bool,
}

const fn one() -> u32 {
    1
}

const fn hour() -> f64 {
    3600.0
}

const fn eight_gib() -> u64 {
    8192
}

const fn quarter_gib() -> u64 {
    256
}

impl AllowEntry {
    /// Creates an entry for a program and its arguments with default limits.
    pub fn new(program: PathBuf, arguments: Vec<String>) -> Self {
        Self {
            program,
            arguments,
            files: None,
            cores: one(),
            at_once: None,
            wall_s: hour(),
            memory_mib: eight_gib(),
            output_mib: quarter_gib(),
            folder: None,
            environment: BTreeMap::new(),
            pass: Vec::new(),
            version: Vec::new(),
            keep_failed: false,
        }
    }

    /// Returns the maximum number of simultaneous runs on this machine; `None` where only the number of slots
    /// limits them.
    pub fn max_concurrent(&self) -> Option<u32> {
        let threads = thread::available_parallelism().map_or(1, std::num::NonZero::get);
        let threads = u32::try_from(threads).unwrap_or(u32::MAX);
        let fit = (self.cores > 1).then(|| (threads / self.cores).max(1));
        match (self.at_once, fit) {
            (Some(stated), Some(fit)) => Some(stated.min(fit).max(1)),
            (stated, fit) => stated.or(fit).map(|places| places.max(1)),
        }
    }
}

/// Returns the path of the list of allowed programs for this machine and user.
pub fn path() -> PathBuf {
    let of = |name: &str| {
        env::var_os(name)
            .filter(|value| !value.is_empty())
            .map(PathBuf::from)
    };
    of(VARIABLE).unwrap_or_else(|| {
        let folder = of("XDG_CONFIG_HOME")
            .or_else(|| Some(of("HOME")?.join(".config")))
            .unwrap_or_else(|| PathBuf::from("/etc"));
        folder.join("horsehead/allow.toml")
    })
}

/// Reads a list of allowed programs; a file that does not exist allows nothing.
///
/// # Errors
/// The file cannot be read, is not a valid list, or contains an entry with impossible limits.
pub fn read(path: &Path) -> Result<Allowed, Problem> {
    let file = path.display().to_string();
    let problem = |line, found: String| Problem {
        file: file.clone(),
        line,
        found,
        allowed: "a list of allowed programs".to_owned(),
        remedy: "correct it, or remove it and allow cases anew with `horsehead allow CASE`"
            .to_owned(),
    };
    let text = match fs::read_to_string(path) {
        Ok(text) => text,
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Allowed::default()),
        Err(error) => return Err(problem(None, error.to_string())),
    };
    let allowed: Allowed = toml::from_str(&text).map_err(|error| {
        let before = error.span().and_then(|span| text.get(..span.start));
        let line = before.map(|before| before.lines().count().max(1));
        problem(line, error.message().to_owned())
    })?;
    for (name, entry) in &allowed.entry {
        let fault = if entry.program.as_os_str().is_empty() {
            Some("program is empty".to_owned())
        } else if !(entry.wall_s > 0.0 && entry.wall_s.is_finite()) {
            Some(format!("wall_s = {}", entry.wall_s))
        } else if entry.cores == 0 || entry.at_once == Some(0) {
            Some("cores or at_once is 0".to_owned())
        } else {
            None
        };
        if let Some(fault) = fault {
            return Err(problem(None, format!("entry `{name}`: {fault}")));
        }
    }
    Ok(allowed)
}

/// Formats a list of allowed programs as TOML.
pub fn text(allowed: &Allowed) -> String {
    // what is made of tables, texts and numbers can be written
    toml::to_string(allowed).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_list_comes_back_and_what_is_impossible_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("allow.toml");
        assert_eq!(read(&path), Ok(Allowed::default()));
        let entry = AllowEntry::new("/bin/true".into(), vec!["-x".to_owned()]);
        let allowed = Allowed {
            entry: [("a".to_owned(), entry)].into(),
        };
        fs::write(&path, text(&allowed)).unwrap();
        assert_eq!(read(&path), Ok(allowed));
        for (bad, words) in [
            ("[entry.a]\nprogram = \"\"\n", "program is empty"),
            ("[entry.a]\nprogram = \"x\"\nwall_s = 0.0\n", "wall_s"),
            ("[entry.a]\nprogram = \"x\"\ncores = 0\n", "cores"),
            ("[entry.a]\nprogramme = \"x\"\n", "programme"),
            ("entry = 3\n", "line 1"),
        ] {
            fs::write(&path, bad).unwrap();
            let error = read(&path).unwrap_err().to_string();
            assert!(error.contains(words), "{bad}: {error}");
        }
    }

    #[test]
    fn places_follow_from_cores_and_what_is_stated() {
        let mut entry = AllowEntry::new("/bin/true".into(), Vec::new());
        assert_eq!(entry.max_concurrent(), None);
        entry.at_once = Some(3);
        assert_eq!(entry.max_concurrent(), Some(3));
        entry.cores = u32::MAX;
        assert_eq!(entry.max_concurrent(), Some(1));
    }
}
