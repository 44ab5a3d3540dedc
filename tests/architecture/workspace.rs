//! Packages of the workspace and their targets, as cargo sees them.
use serde_json::Value;
use std::{path::PathBuf, process::Command};

/// All packages.
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

/// Names of what a package depends on, and whether its tests alone do.
pub(crate) fn dependencies(package: &Value) -> Vec<(&str, bool)> {
    let all = package["dependencies"].as_array().into_iter().flatten();
    all.filter_map(|one| Some((one["name"].as_str()?, one["kind"] == "dev")))
        .collect()
}

/// Root files of a package's library, programs, tests and benches, each with a name for messages.
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
