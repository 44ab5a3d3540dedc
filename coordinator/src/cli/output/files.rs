//! Checks of output folders that the user names on the command line.
use report::document::GENERATOR;
use run::folder::MANIFEST;
use std::{fs, path::Path};
use support::Problem;

/// Checks that a report can be written into the folder given by the user, before any simulation is run for it. Unless
/// `force` is set, the folder must be new or empty, or hold a report of this program that is no run's.
pub(crate) fn check_out(folder: &Path, force: bool) -> Result<(), Problem> {
    if !force {
        check_vacant(folder)?;
    }
    let tried = fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    match tried {
        Ok(_) => Ok(()),
        Err(error) => Err(Problem {
            message: format!("cannot write into {}: {error}", folder.display()),
            remedy: "choose a folder that can be written, with --out DIR".to_owned(),
        }),
    }
}

fn check_vacant(folder: &Path) -> Result<(), Problem> {
    let has = |name: &str| folder.join(name).exists();
    let is_empty = fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none());
    let own = fs::read_to_string(folder.join("report.html"));
    let is_own = own.is_ok_and(|page| page.contains(GENERATOR));
    let what = if has("case.toml") {
        "is a case folder"
    } else if has(MANIFEST) {
        "is the folder of a run"
    } else if is_empty || is_own {
        return Ok(());
    } else {
        "holds other files, or a report of an earlier version"
    };
    Err(Problem {
        message: format!("{} {what}", folder.display()),
        remedy: "choose a new folder with --out DIR, or write into this one with --force"
            .to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_no_folder_for_results() {
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("file");
        fs::write(&file, "").unwrap();
        assert!(check_out(&file, false).is_err());
        check_out(&scratch.path().join("new"), false).unwrap();
    }

    /// Checks that a folder of somebody else, of a case or of a run is refused, and that a report of this program
    /// is replaced.
    #[test]
    fn only_reports_of_this_program_are_replaced() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        check_out(folder, false).unwrap();
        let own = report::page(&report::Report::new(String::new(), "", []));
        for (name, content, refused) in [
            ("report.html", own.as_str(), None),
            ("report.html", "<h1>mine</h1>", Some("holds other files")),
            ("report.html", own.as_str(), None),
            (MANIFEST, "{}", Some("folder of a run")),
            ("case.toml", "", Some("case folder")),
        ] {
            fs::write(folder.join(name), content).unwrap();
            let said = check_out(folder, false).err().map(|error| error.message);
            match refused {
                Some(words) => assert!(said.is_some_and(|said| said.contains(words)), "{words}"),
                None => assert_eq!(said, None),
            }
            check_out(folder, true).unwrap();
        }
    }
}
