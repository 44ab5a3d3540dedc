//! Arguments of the studies that fit a case, or begin with a calibration: `diagnose` and `identify`.
use super::case::case_folder;
use clap::Args;
use run::target::StudyTarget;
use std::path::PathBuf;

/// What a study is made of, and where it is kept.
#[derive(Debug, Args)]
pub(crate) struct StudyArguments {
    /// Case folder, or the folder of a finished calibration.
    #[arg(value_name = "CASE|RUN", value_parser = case_folder)]
    target: PathBuf,
    /// Folder whose inputs and records replace those of the case: a new test of the
    /// same machine.
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_MEASURED")]
    measured: Option<PathBuf>,
    /// Gene file to start the fit from, such as a run's `calibrated.toml`.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// Take every derivative as a difference of whole simulations, as if the model gave none: slower, and a
    /// check of the exact derivatives.
    #[arg(long, env = "HORSEHEAD_DIFFERENCES")]
    pub(crate) differences: bool,
    /// Fixes every random choice: the same seed gives the same bits [default: that of the calibration, or 1].
    #[arg(long, env = "HORSEHEAD_SEED")]
    pub(crate) seed: Option<u64>,
    /// Run folder [default: runs/CASE-COMMAND-seedN, COMMAND being this one, with what distinguishes the calibration,
    /// --genes, the effects of the case and --measured].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    pub(crate) run: Option<PathBuf>,
}

impl StudyArguments {
    /// Reads the case, its records and the start of the fit.
    ///
    /// # Errors
    /// If one of them cannot be read or is invalid.
    pub(crate) fn read(&self) -> anyhow::Result<StudyTarget> {
        StudyTarget::read(
            &self.target,
            self.measured.as_deref(),
            self.genes.as_deref(),
        )
    }
}
