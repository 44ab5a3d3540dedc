//! Checks of output folders that the user names on the command line.
use super::problem::Problem;
use std::path::Path;

/// Checks that the output folder given by the user can be written, before any simulation is run for it.
pub(crate) fn check_out(folder: &Path) -> Result<(), Problem> {
    let tried = std::fs::create_dir_all(folder).and_then(|()| tempfile::tempfile_in(folder));
    match tried {
        Ok(_) => Ok(()),
        Err(error) => Err(Problem {
            message: format!("cannot write into {}: {error}", folder.display()),
            remedy: "choose a folder that can be written, with --out DIR".to_owned(),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_no_folder_for_results() {
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("file");
        std::fs::write(&file, "").unwrap();
        assert!(check_out(&file).is_err());
        check_out(&scratch.path().join("new")).unwrap();
    }
}
