//! Packages of the workspace and their targets, as reported by `cargo metadata`.
use serde_json::Value;
use std::{path::PathBuf, process::Command};

/// Returns the metadata of all packages of the workspace.
pub(crate) fn packages() -> Vec<Value> {
    let arguments = [
        "metadata",
        "--format-version",
        "1",
        "--no-deps",
        "--offline",
    ];
    let out = Command::new(env!("CARGO")).args(arguments).output();
    let meta: Value = serde_json::from_slice(&out.expect("cargo runs").stdout).expect("metadata");
    meta["packages"].as_array().cloned().expect("packages")
}

/// Returns the names of a package's dependencies, each with whether it is a development dependency.
pub(crate) fn dependencies(package: &Value) -> Vec<(&str, bool)> {
    let all = package["dependencies"].as_array().into_iter().flatten();
    all.filter_map(|one| Some((one["name"].as_str()?, one["kind"] == "dev")))
        .collect()
}

/// Returns the root files of a package's library, programs, tests and benchmarks, each with a label for
/// messages.
pub(crate) fn targets(package: &Value) -> Vec<(String, PathBuf)> {
    let name = package["name"].as_str().expect("a name");
    let all = package["targets"].as_array().into_iter().flatten();
    all.filter(|target| target["kind"][0] != "custom-build")
        .map(|target| {
            let path = target["src_path"].as_str().expect("a path");
            let label = format!("{name} ({} {})", target["kind"][0], target["name"]);
            (label.replace('"', ""), PathBuf::from(path))
        })
        .collect()
}
