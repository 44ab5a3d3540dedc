//! Determines the kind of a run from its run folder; no other module does so.
use super::{
    calibration::{self, Calibration},
    diagnosis::Diagnosis,
    folder::RunFolder,
    identification::{self, Identification},
    manifest::{CALIBRATE, DIAGNOSE, IDENTIFY, RunIdentity as _},
    opened::Run,
    orthogonal::Orthogonal,
    sweep_file::SweptFile,
};
use crate::cli::{
    argument::output::Output,
    output::{
        calibration::{calibration as calibration_data, show},
        diagnosis::DiagnosisOutput,
        identification::{show as identified, subject as identification_data},
        problem::Problem,
        sweep::{file_report, show_file, show_test, test_report},
    },
};
use protocol::case::Case;
use report::Report;
use std::path::Path;

/// Run of any kind whose result can be shown, opened from its run folder.
pub(crate) enum AnyRun {
    Calibration(Calibration),
    Diagnosis(Diagnosis),
    Identification(Identification),
    /// Orthogonal test.
    Test(Run<Orthogonal>),
    /// Sweep of a file.
    Sweep(Run<SweptFile>),
}

impl AnyRun {
    /// Kinds of run whose result can be shown.
    pub(crate) const KINDS: [&str; 5] = [
        CALIBRATE,
        DIAGNOSE,
        IDENTIFY,
        Orthogonal::KIND,
        SweptFile::KIND,
    ];

    /// Opens an existing run.
    ///
    /// # Errors
    /// If the folder holds no run, or a run of a kind that this version does not know.
    pub(crate) fn open(path: &Path) -> anyhow::Result<Self> {
        let head = RunFolder::at(path)?.head()?;
        match head.kind.as_str() {
            CALIBRATE => Ok(Self::Calibration(Run::open(path)?)),
            DIAGNOSE => Ok(Self::Diagnosis(Run::open(path)?)),
            IDENTIFY => Ok(Self::Identification(Run::open(path)?)),
            Orthogonal::KIND => Ok(Self::Test(Run::open(path)?)),
            SweptFile::KIND => Ok(Self::Sweep(Run::open(path)?)),
            other => Err(Problem {
                message: format!("{} holds a run of `horsehead {other}`", path.display()),
                remedy: "name the folder of a calibration, a diagnosis, an identification, a grid, a table or an orthogonal test; \
                         `horsehead export` takes the others"
                    .to_owned(),
            }
            .into()),
        }
    }

    /// Returns the case of the run, as it was when the run was begun.
    pub(crate) const fn case(&self) -> &Case {
        match self {
            Self::Calibration(run) => &run.case,
            Self::Diagnosis(run) => &run.case,
            Self::Identification(run) => &run.case,
            Self::Test(run) => &run.case,
            Self::Sweep(run) => &run.case,
        }
    }

    /// Reads the result of the finished run from its journal and builds its report; the sessions of the run took
    /// `wall_s` seconds in total.
    ///
    /// # Errors
    /// If the run is not finished, or its journal or a file of its folder cannot be read.
    pub(crate) fn report(&self, wall_s: f64) -> anyhow::Result<Report> {
        Ok(match self {
            Self::Calibration(run) => {
                let recorded = calibration::recorded(run)?;
                report::calibration(&calibration_data(run, &recorded, wall_s)?)
            }
            Self::Diagnosis(run) => {
                let answer = DiagnosisOutput::read(run, wall_s)?;
                report::diagnosis::report(&answer.subject()?)
            }
            Self::Identification(run) => {
                let recorded = identification::recorded(run)?;
                report::identification::report(&identification_data(run, &recorded, wall_s)?)
            }
            Self::Test(run) => test_report(run)?,
            Self::Sweep(run) => file_report(run)?,
        })
    }

    /// Reads the result of the finished run from its journal, writes its files and prints it.
    ///
    /// # Errors
    /// As [`Self::report`], and if a file cannot be written.
    pub(crate) fn show(&self, output: Output) -> anyhow::Result<()> {
        match self {
            Self::Calibration(run) => show(run, run.manifest.wall_s, output),
            Self::Diagnosis(run) => {
                let answer = DiagnosisOutput::read(run, run.manifest.wall_s)?;
                let object = answer.write()?;
                answer.print(output, &object)
            }
            Self::Identification(run) => identified(run, run.manifest.wall_s, output),
            Self::Test(run) => show_test(run, output),
            Self::Sweep(run) => show_file(run, output),
        }
    }
}
