//! Assignment of workers' key folders to hosts.
//!
//! A file in each assigned folder names its host, so that a host gets the same folder again. If there are
//! more hosts than folders, `horsehead keys add` creates new ones, with names that a running coordinator
//! already accepts.
use super::{
    host::Host,
    plan::{PlanStep, STEP, StepInput},
};
use link::keys::{CA_KEY, KeyRole, Keys, pool};
use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};
use support::Problem;

/// File in a worker's key folder that names the host holding a copy of it.
const HOST: &str = "host";

/// Returns the key folder names of the hosts, in order, and the steps that create missing folders.
///
/// # Errors
/// If the folder cannot be used by a coordinator, or new names are needed and the folder cannot sign
/// certificates.
pub fn assign(folder: &Path, hosts: &[Host]) -> Result<(Vec<String>, Vec<PlanStep>), Problem> {
    let keys = Keys::read(folder, KeyRole::Coordinator).map_err(|error| {
        let help = "--tls takes the folder that `horsehead keys new DIR --host NAME` made";
        Problem::new(error.to_string(), help)
    })?;
    let mut free: BTreeSet<&String> = keys.workers().iter().collect();
    // folders that were taken away, or given to somebody by hand, are no use
    free.retain(|name| folder.join(name).is_dir());
    let given = |name: &String| fs::read_to_string(folder.join(name).join(HOST)).ok();
    let mut names: Vec<Option<String>> = Vec::new();
    for host in hosts {
        let same = |name: &&String| given(name).is_some_and(|at| at.trim() == host.to_string());
        let name = free.iter().copied().find(same);
        names.extend([name.cloned()]);
        name.map(|name| free.remove(name));
    }
    free.retain(|name| given(name).is_none());
    let mut unused = pool();
    let (mut all, mut made, mut steps) = (Vec::new(), Vec::new(), Vec::new());
    for (host, name) in hosts.iter().zip(names) {
        let is_new = name.is_none();
        let known = name.or_else(|| free.pop_first().cloned());
        let vacant = |name: &String| !keys.workers().contains(name) && !folder.join(name).exists();
        let name = if let Some(name) = known {
            name
        } else {
            let name = unused.find(vacant).ok_or_else(|| {
                Problem::new(
                    format!(
                        "{}: all available worker names are in use",
                        folder.display()
                    ),
                    "remove folders of nodes that are gone, and their lines in `workers`",
                )
            })?;
            made.push(name.clone());
            name
        };
        if is_new {
            steps.push(PlanStep::Write {
                path: folder.join(&name).join(HOST),
                content: format!("{host}\n"),
            });
        }
        all.push(name);
    }
    if !made.is_empty() {
        if !folder.join(CA_KEY).exists() {
            return Err(Problem::new(
                format!(
                    "{} has no folder for {} of the hosts, and cannot sign new ones without {CA_KEY}",
                    folder.display(),
                    made.len()
                ),
                "name the folder that `horsehead keys new` made, with its authority's key",
            ));
        }
        let this = std::env::current_exe().unwrap_or_else(|_| PathBuf::from("horsehead"));
        let words = [this.display().to_string(), "keys".into(), "add".into()];
        let words = words.into_iter().chain([folder.display().to_string()]);
        steps.insert(
            0,
            PlanStep::Run {
                what: "make keys for further workers".to_owned(),
                command: words.chain(made).collect(),
                input: StepInput::Nothing,
                only_if: None,
                asks: false,
                limit: STEP,
                remedy: "see what `horsehead keys check DIR` says of the folder".to_owned(),
            },
        );
    }
    Ok((all, steps))
}

/// Returns the host to which a worker's key folder is assigned.
///
/// # Errors
/// If there is no such folder, or it is not assigned to a host.
pub fn host_of(folder: &Path, name: &str) -> Result<Host, Problem> {
    let file = folder.join(name).join(HOST);
    let text = fs::read_to_string(&file).map_err(|error| {
        Problem::new(
            format!("{}: {error}", file.display()),
            "launching by ssh with this folder as --tls gives hosts their keys and writes this file",
        )
    })?;
    text.trim().parse()
}
