//! Arguments of the assessments of a machine: `life` and `balance`.
use super::case::case_folder;
use clap::Args;
use run::assessment::AssessmentTarget;
use std::path::PathBuf;

/// Machine that is assessed, and where the assessment is kept.
#[derive(Debug, Args)]
pub(crate) struct AssessmentArguments {
    /// Case folder, or the folder of a finished calibration or diagnosis.
    #[arg(value_name = "CASE|RUN", value_parser = case_folder)]
    target: PathBuf,
    /// Gene file whose parameters are assessed, such as a run's `calibrated.toml`; the recommended ones by default.
    #[arg(long, value_name = "FILE", env = "HORSEHEAD_GENES")]
    genes: Option<PathBuf>,
    /// Folder of the assessment [default: COMMAND, which is this one, in the folder of the run, or
    /// runs/CASE-COMMAND-HASH-seed0].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    pub(crate) run: Option<PathBuf>,
}

impl AssessmentArguments {
    /// Reads the machine.
    ///
    /// # Errors
    /// If the case, the run or the gene file cannot be read or is invalid.
    pub(crate) fn read(&self) -> anyhow::Result<AssessmentTarget> {
        AssessmentTarget::read(&self.target, self.genes.as_deref())
    }
}
