//! `horsehead export --failed RUN`: writes the files that an external program left in each failed simulation
//! into folders for inspection.
use anyhow::Context as _;
use journal::event::{Event, Finished};
use protocol::{
    file::is_below,
    job::{Failure, FailureFiles, Outcome},
};
use run::folder::RunFolder;
use serde::Serialize;
use std::{
    fmt::Write as _,
    fs,
    os::unix::fs::PermissionsExt,
    path::{Path, PathBuf},
};
use support::Problem;

const FOLDER: &str = "failed";
/// Name of the file in each job's folder that states why the job failed.
const WHY: &str = "why.txt";

/// JSON object printed by `export --failed --output json`.
#[derive(Debug, Serialize)]
pub(super) struct FailedOutput {
    run: String,
    /// Folder that contains the folders of the failed jobs; null if no files were left.
    folder: Option<String>,
    /// All jobs of the run that were given up.
    failed: Vec<OneFailed>,
    /// Descriptions of data missing because the journal is damaged.
    pub(super) notes: Vec<String>,
}

/// Job that was given up after failed attempts.
#[derive(Debug, Serialize)]
struct OneFailed {
    /// Number of the job, as in the table `results`.
    job: u64,
    /// Kind of failure for which the job was given up.
    kind: &'static str,
    /// Description of the failure for which the job was given up.
    why: String,
    /// Folder of this job; null if the worker sent no files.
    folder: Option<String>,
    /// Paths of the files in the job's folder, relative to the external program's working folder.
    files: Vec<String>,
    /// Paths of the files of which the worker sent only the end, or nothing.
    shortened: Vec<String>,
}

/// Writes the files of failed jobs into folders below `to`, or below the run folder; returns a list of all
/// given-up jobs.
pub(super) fn fetch(run: &Path, to: Option<&Path>, force: bool) -> anyhow::Result<FailedOutput> {
    let folder = RunFolder::at(run)?;
    let file = folder.file(journal::FILE);
    if !file.exists() {
        return Err(Problem {
            message: format!("{} has no journal yet", folder.path().display()),
            remedy:
                "start the run again with the command that created it; the journal is written then"
                    .to_owned(),
        }
        .into());
    }
    let mut failures: Vec<(u64, Failure)> = Vec::new();
    let report = journal::fold(&file, |_, event| {
        if let Event::Finished(finished) = event
            && let Finished {
                attempt,
                outcome: Outcome::Failed(failure),
                ..
            } = *finished
        {
            failures.push((attempt.job.0, failure));
        }
    })?;
    failures.sort_by_key(|(job, _)| *job);
    let any = failures
        .iter()
        .any(|(_, failure)| failure.files().is_some_and(|left| !left.is_empty()));
    let place = to.map_or_else(|| folder.file(FOLDER), Path::to_path_buf);
    if any {
        prepare(&place, to.is_none(), force)?;
    }
    let one = |(job, failure): (u64, Failure)| -> anyhow::Result<OneFailed> {
        let left = failure.files().filter(|left| !left.is_empty());
        let folder = place.join(job.to_string());
        let why = failure.to_string();
        if let Some(left) = left {
            unpack(&folder, &why, left)?;
        }
        Ok(OneFailed {
            job,
            kind: failure.kind(),
            folder: left.map(|_| folder.display().to_string()),
            files: left.map_or_else(Vec::new, |left| {
                left.files.iter().map(|file| file.path.clone()).collect()
            }),
            shortened: left.map_or_else(Vec::new, |left| {
                left.shortened.iter().map(|one| one.path.clone()).collect()
            }),
            why,
        })
    };
    Ok(FailedOutput {
        run: run.display().to_string(),
        folder: any.then(|| place.display().to_string()),
        failed: failures.into_iter().map(one).collect::<Result<_, _>>()?,
        notes: journal::describe_damage(&report.damage),
    })
}

/// Creates an empty folder for the files of failed jobs: the run's own folder for them is replaced; a folder
/// chosen by the user must be empty unless `force` is set.
fn prepare(place: &Path, is_own: bool, force: bool) -> anyhow::Result<()> {
    let is_empty = fs::read_dir(place).map_or(true, |mut entries| entries.next().is_none());
    if !is_empty {
        if !is_own && !force {
            return Err(Problem {
                message: format!("{} is not empty", place.display()),
                remedy: "choose another place with --to, or write into it with --force".to_owned(),
            }
            .into());
        }
        if is_own {
            fs::remove_dir_all(place)?;
        }
    }
    fs::create_dir_all(place).with_context(|| format!("cannot make {}", place.display()))
}

/// Writes the files that a failed job left; paths that would lead outside `folder` are skipped, since they
/// come from a worker.
fn unpack(folder: &Path, why: &str, left: &FailureFiles) -> anyhow::Result<()> {
    fs::create_dir_all(folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for file in &left.files {
        // a worker says what it likes
        if !is_below(Path::new(&file.path)) {
            continue;
        }
        let path: PathBuf = folder.join(&file.path);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)
                .with_context(|| format!("cannot make {}", parent.display()))?;
        }
        fs::write(&path, &file.content)
            .with_context(|| format!("cannot write {}", path.display()))?;
        let mode = if file.executable { 0o700 } else { 0o600 };
        fs::set_permissions(&path, fs::Permissions::from_mode(mode))?;
    }
    let mut text = format!("{why}\n");
    for one in &left.shortened {
        let kept = match one.kept {
            0 => "was not sent".to_owned(),
            kept => format!("its last {kept} are here"),
        };
        // writing to a string does not fail
        let _written = writeln!(text, "{}: of {} bytes {kept}", one.path, one.bytes);
    }
    let path = folder.join(WHY);
    fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))
}

pub(super) fn text(object: &FailedOutput) -> String {
    if object.failed.is_empty() {
        return "no run was given up\n".to_owned();
    }
    let one = |failed: &OneFailed| {
        let first = failed.why.lines().next().unwrap_or_default();
        let place = failed.folder.as_deref().unwrap_or("no files were sent");
        format!("{:>9}  {place}: {first}\n", failed.job)
    };
    object.failed.iter().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use protocol::{file::File, job::TruncatedFile};

    #[test]
    fn what_was_left_is_written_below_its_folder_and_nowhere_else() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("7");
        let file = |path: &str| File {
            path: path.to_owned(),
            content: b"x".to_vec(),
            executable: false,
        };
        let left = FailureFiles {
            files: vec![
                file("work/deep/log"),
                file("../outside"),
                file("/tmp/absolute"),
            ],
            shortened: vec![TruncatedFile {
                path: "work/long".to_owned(),
                bytes: 100,
                kept: 10,
            }],
        };
        unpack(&folder, "it ended with status 1", &left).unwrap();
        assert_eq!(fs::read(folder.join("work/deep/log")).unwrap(), b"x");
        assert!(!place.path().join("outside").exists());
        let why = fs::read_to_string(folder.join(WHY)).unwrap();
        assert_eq!(
            why,
            "it ended with status 1\nwork/long: of 100 bytes its last 10 are here\n"
        );
    }
}
