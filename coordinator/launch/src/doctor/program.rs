//! Diagnosis of this machine: whether the worker program is present.
use super::check::{Check, Layer};
use std::{fmt::Display, path::PathBuf, process::Command};

/// Checks whether the located worker program starts and has the version of this program.
pub fn program(located: Result<PathBuf, impl Display>) -> Check {
    let path = match located {
        Ok(path) => path,
        Err(error) => {
            return Check::bad(
                Layer::Program,
                error.to_string(),
                "build horsehead and horsehead-worker from the same source",
            );
        }
    };
    let own = env!("CARGO_PKG_VERSION");
    let place = path.display();
    let remedy = "copy horsehead-worker of the same build into the folder of this program";
    match Command::new(&path).arg("--version").output() {
        Ok(said) => {
            let said = String::from_utf8_lossy(&said.stdout).trim().to_owned();
            if said.split(' ').next_back() == Some(own) {
                Check::good(Layer::Program, format!("{place}: {said}"))
            } else {
                let found = format!("{place} reports `{said}` instead of version {own}");
                Check::bad(Layer::Program, found, remedy)
            }
        }
        Err(error) => Check::bad(Layer::Program, format!("{place}: {error}"), remedy),
    }
}
