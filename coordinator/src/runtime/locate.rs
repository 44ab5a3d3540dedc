//! Finding the worker program, which is a program of its own beside this one.
use std::{
    env,
    io::{self, Write},
    path::{Path, PathBuf},
    process::{Command, Stdio},
};

/// Name of the worker program.
const PROGRAM: &str = "horsehead-worker";
/// Environment variable: path of the worker program, instead of a search.
pub const WORKER_PROGRAM: &str = "HORSEHEAD_WORKER";

/// Why there is no worker program.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LocateError {
    /// It is nowhere.
    #[error(
        "{PROGRAM} is neither beside {} nor on PATH: build it with `cargo build`, install it with \
         `cargo install --path worker`, or say where it lies in {WORKER_PROGRAM}",
        beside.display()
    )]
    Missing {
        /// The folder of this program.
        beside: PathBuf,
    },
    /// `cargo` was asked for it and failed.
    #[error("{PROGRAM} could not be built: {reason}")]
    Build {
        /// What cargo said.
        reason: String,
    },
}

/// The worker program: the one named by [`WORKER_PROGRAM`]; under `cargo run` the one built now, so
/// that it is never older than this program, and under `cargo test` the one in the target folder;
/// the one beside this program; the one on `PATH`.
///
/// # Errors
/// [`LocateError::Missing`] with what to do, or [`LocateError::Build`].
pub fn worker_program() -> Result<PathBuf, LocateError> {
    if let Some(path) = env::var_os(WORKER_PROGRAM).filter(|path| !path.is_empty()) {
        return Ok(path.into());
    }
    let this = env::current_exe().unwrap_or_default();
    let folder = this.parent().unwrap_or(Path::new("")).to_owned();
    if let Some(cargo) = env::var_os("CARGO")
        && let Some(target) = Target::of(&folder)
    {
        let built = target.folder.join(PROGRAM);
        // `cargo test --workspace` has just built it, for the worker's own tests
        if folder.ends_with("deps") && built.is_file() {
            return Ok(built);
        }
        return build(Path::new(&cargo), &target);
    }
    let beside = folder.join(PROGRAM);
    if beside.is_file() {
        return Ok(beside);
    }
    let path = env::var_os("PATH").unwrap_or_default();
    env::split_paths(&path)
        .map(|folder| folder.join(PROGRAM))
        .find(|program| program.is_file())
        .ok_or(LocateError::Missing { beside: folder })
}

/// A folder into which cargo builds.
struct Target {
    /// As `target/debug`.
    folder: PathBuf,
    /// As `--profile` names it.
    profile: String,
}

impl Target {
    /// Recognises the folder of a program that cargo built; tests lie in `deps`.
    fn of(folder: &Path) -> Option<Self> {
        let folder = if folder.ends_with("deps") {
            folder.parent()?
        } else {
            folder
        };
        folder.join(".fingerprint").is_dir().then_some(())?;
        let profile = match folder.file_name()?.to_str()? {
            "debug" => "dev",
            other => other,
        };
        Some(Self {
            folder: folder.to_owned(),
            profile: profile.to_owned(),
        })
    }
}

/// Builds the worker like this program was built; quick if nothing has changed.
fn build(cargo: &Path, target: &Target) -> Result<PathBuf, LocateError> {
    let failed = |reason: String| LocateError::Build { reason };
    let program = target.folder.join(PROGRAM);
    if !program.is_file() {
        let line = format!("building {PROGRAM} with cargo; the first time takes a while\n");
        // a message that nobody sees is no reason to fail
        drop(io::stderr().write_all(line.as_bytes()));
    }
    let mut command = Command::new(cargo);
    command
        // all packages of the workspace, so that their dependencies are those already built
        .args(["build", "--quiet", "--workspace", "--bin", PROGRAM, "--profile", &target.profile])
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    // what the outer cargo says of the program it runs would make build scripts run again
    for (name, _) in env::vars_os() {
        let name = name.to_string_lossy().into_owned();
        let of_package = [
            "CARGO_PKG_",
            "CARGO_MANIFEST_",
            "CARGO_BIN_",
            "CARGO_CRATE_",
        ];
        if name == "LD_LIBRARY_PATH" || of_package.iter().any(|start| name.starts_with(start)) {
            command.env_remove(name);
        }
    }
    if let Some(root) = target.folder.parent() {
        command.arg("--target-dir").arg(root);
    }
    if let Some(package) = env::var_os("CARGO_MANIFEST_DIR") {
        command.current_dir(package);
    }
    let output = command
        .output()
        .map_err(|error| failed(error.to_string()))?;
    if !output.status.success() {
        let words = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(failed(words));
    }
    if program.is_file() {
        Ok(program)
    } else {
        Err(failed("cargo built it elsewhere".to_owned()))
    }
}
