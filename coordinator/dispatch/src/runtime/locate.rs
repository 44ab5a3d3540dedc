//! Search for the worker program, a separate executable in the same folder. It is never built from here:
//! `cargo build` makes both.
use std::{
    env,
    ffi::OsStr,
    path::{Path, PathBuf},
};

/// Name of the worker program.
const PROGRAM: &str = "horsehead-worker";
/// Environment variable with the path of the worker program, which replaces the search.
pub const WORKER_PROGRAM: &str = "HORSEHEAD_WORKER";

/// The worker program was not found.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LocateError {
    /// The worker program was not found where it is searched.
    #[error(
        "{PROGRAM} is neither beside {} nor on PATH: build both programs with `cargo build --release`, \
         install it with `cargo install --path worker`, or say where it lies in {WORKER_PROGRAM}",
        beside.display()
    )]
    NotFound {
        /// Folder of the running program, in which the worker program was expected.
        beside: PathBuf,
    },
    /// The environment variable [`WORKER_PROGRAM`] names no file.
    #[error(
        "there is no file {}, which the environment variable {WORKER_PROGRAM} names: correct it, or remove it so that \
         {PROGRAM} beside this program is used",
        path.display()
    )]
    Named {
        /// Path that the variable states.
        path: PathBuf,
    },
}

/// Returns the path of the worker program: that in [`WORKER_PROGRAM`], else in the folder of this program
/// (for a cargo test, the folder above), else on `PATH`.
///
/// # Errors
/// [`LocateError`] with the remedy.
pub fn worker_program() -> Result<PathBuf, LocateError> {
    if let Some(path) = env::var_os(WORKER_PROGRAM).filter(|path| !path.is_empty()) {
        let path = PathBuf::from(path);
        // a name without a folder is searched on PATH when it is started
        let is_path = path.components().count() > 1;
        return if is_path && !path.is_file() {
            Err(LocateError::Named { path })
        } else {
            Ok(path)
        };
    }
    let this = env::current_exe().unwrap_or_default();
    let folder = this.parent().unwrap_or(Path::new(""));
    let folder = if folder.ends_with("deps") {
        folder.parent().unwrap_or(folder)
    } else {
        folder
    };
    nearest(folder, &env::var_os("PATH").unwrap_or_default()).ok_or_else(|| LocateError::NotFound {
        beside: folder.to_owned(),
    })
}

/// Returns the path of the worker program in `folder`, or else in the first folder of the search path `path`
/// that has it.
fn nearest(folder: &Path, path: &OsStr) -> Option<PathBuf> {
    let folders = [folder.to_owned()]
        .into_iter()
        .chain(env::split_paths(path));
    let mut programs = folders.map(|folder| folder.join(PROGRAM));
    programs.find(|program| program.is_file())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_one_beside_comes_before_the_one_on_the_path() {
        let [beside, first, second] = [(); 3].map(|()| tempfile::tempdir().unwrap());
        let path = env::join_paths([first.path(), second.path()]).unwrap();
        let found = || nearest(beside.path(), &path);
        assert_eq!(found(), None);
        for folder in [&second, &first, &beside] {
            let program = folder.path().join(PROGRAM);
            std::fs::write(&program, "").unwrap();
            assert_eq!(found(), Some(program));
        }
        let words = LocateError::NotFound {
            beside: beside.path().to_owned(),
        };
        assert!(words.to_string().contains("cargo build --release"));
    }
}
