//! Run of any kind as a reader sees it. The kind is determined from the run folder here and nowhere else.
use crate::{
    calibration::{self, CalibrationRun},
    diagnosis::{self, DiagnosisRun},
    folder::RunFolder,
    identification::{self, IdentificationRun},
    manifest::{CALIBRATE, DIAGNOSE, IDENTIFY, RunIdentity as _},
    opened::Run,
    orthogonal::{self, Orthogonal},
    sweep_file::{self, SweptFile},
};
use protocol::case::Case;
use report::Report;
use std::path::Path;
use support::Problem;

/// Run of any kind whose result can be shown, opened from its run folder.
pub enum AnyRun {
    /// Calibration.
    Calibration(CalibrationRun),
    /// Diagnosis.
    Diagnosis(DiagnosisRun),
    /// Identifiability analysis.
    Identification(IdentificationRun),
    /// Orthogonal test.
    Test(Run<Orthogonal>),
    /// Sweep of a file.
    Sweep(Run<SweptFile>),
}

impl AnyRun {
    /// Kinds of run whose result can be shown.
    pub const KINDS: [&str; 5] = [
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
    pub fn open(path: &Path) -> anyhow::Result<Self> {
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
    pub const fn case(&self) -> &Case {
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
    pub fn report(&self, wall_s: f64) -> anyhow::Result<Report> {
        Ok(match self {
            Self::Calibration(run) => {
                let recorded = calibration::recorded(run)?;
                report::calibration(&calibration::report_data(run, &recorded, wall_s)?)
            }
            Self::Diagnosis(run) => {
                let recorded = diagnosis::recorded(run)?;
                report::diagnosis::report(&diagnosis::report_input(run, &recorded, wall_s)?)
            }
            Self::Identification(run) => {
                let recorded = identification::recorded(run)?;
                let input = identification::report_input(run, &recorded, wall_s)?;
                report::identification::report(&input)
            }
            Self::Test(run) => orthogonal::report(run, &orthogonal::recorded(run)?)?,
            Self::Sweep(run) => sweep_file::report(run, &sweep_file::recorded(run)?)?,
        })
    }
}
