//! This machine alone: whether it has the program of workers.
use super::check::{Check, Layer};
use std::{fmt::Display, path::PathBuf, process::Command};

/// What is found of the worker program, from where it was looked for: whether it starts and is of this version.
pub fn program(located: Result<PathBuf, impl Display>) -> Check {
    let path = match located {
        Ok(path) => path,
        Err(error) => {
            return Check::bad(
                Layer::Program,
                error.to_string(),
                "build both programs together",
            );
        }
    };
    let own = env!("CARGO_PKG_VERSION");
    let place = path.display();
    let remedy = "put the program that was built with this one beside it";
    match Command::new(&path).arg("--version").output() {
        Ok(said) => {
            let said = String::from_utf8_lossy(&said.stdout).trim().to_owned();
            if said.split(' ').next_back() == Some(own) {
                Check::good(Layer::Program, format!("{place}: {said}"))
            } else {
                let found = format!("{place} says it is `{said}`, not version {own}");
                Check::bad(Layer::Program, found, remedy)
            }
        }
        Err(error) => Check::bad(Layer::Program, format!("{place}: {error}"), remedy),
    }
}
