//! Determines the kind of a run (calibration, diagnosis or identification) from its run folder; no other
//! module does so.
use super::{
    calibration::{Calibration, calibrate, recorded},
    diagnosis::{self, Diagnosis, diagnose},
    folder::{RESULT, RunFolder},
    identification::{self, Identification, identify},
    manifest::{CALIBRATE, DIAGNOSE, IDENTIFY},
    opened::Run,
};
use crate::cli::{
    argument::output::Output,
    output::{
        calibration::{calibration as calibration_data, show},
        diagnosis::DiagnosisOutput,
        identification::{show as identified, subject as identification_data},
        object::diagnosis::times::Times,
        problem::Problem,
    },
};
use case::Loaded;
use protocol::case::Case;
use report::Report;
use std::path::Path;
use study::{Evaluator, ProgressView, StageView, Stop, Watch};

/// Run of any kind (calibration, diagnosis or identification), opened from its run folder.
pub(crate) enum AnyRun {
    Calibration(Calibration),
    Diagnosis(Diagnosis),
    Identification(Identification),
}

/// Run together with its result, recomputed from its journal.
pub(crate) enum ReplayedRun<'a> {
    Calibration(&'a Calibration),
    /// Diagnosis and its result, with the case and the measured records read again.
    Diagnosis(&'a Diagnosis, Box<Loaded>, Box<diagnosis::Found>),
    Identification(&'a Identification, Box<identification::Found>),
}

impl AnyRun {
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
            other => Err(Problem {
                message: format!("{} holds a run of `horsehead {other}`", path.display()),
                remedy: "name the folder of a calibration, a diagnosis or an identification"
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
        }
    }

    /// Checks that the run can be replayed: it is finished and its journal exists.
    ///
    /// # Errors
    /// If the run cannot be replayed; the error says how to continue.
    pub(crate) fn check_replayable(&self) -> Result<(), Problem> {
        match self {
            Self::Calibration(run) => run.expect_replayable(),
            Self::Diagnosis(run) => run.expect_replayable(),
            Self::Identification(run) => run.expect_replayable(),
        }
    }

    /// Repeats the study of the run with recorded results instead of simulations.
    ///
    /// # Errors
    /// If the recording lacks a result that the study requests.
    pub(crate) async fn replay<E: Evaluator>(
        &self,
        evaluator: &mut E,
        watch: &mut (impl Watch<ProgressView> + Watch<StageView>),
        stop: &mut Stop,
    ) -> anyhow::Result<ReplayedRun<'_>> {
        Ok(match self {
            Self::Calibration(run) => {
                calibrate(evaluator, run, watch, stop).await?;
                ReplayedRun::Calibration(run)
            }
            Self::Diagnosis(run) => {
                let loaded = Box::new(run.loaded()?);
                let found = diagnose(evaluator, &run.manifest, &loaded, watch, stop).await?;
                ReplayedRun::Diagnosis(run, loaded, Box::new(found))
            }
            Self::Identification(run) => {
                let loaded = run.loaded()?;
                let found = identify(evaluator, &run.manifest, &loaded, watch, stop).await?;
                ReplayedRun::Identification(run, Box::new(found))
            }
        })
    }
}

impl ReplayedRun<'_> {
    /// Builds the report of the run, whose sessions took `wall_s` seconds in total.
    ///
    /// # Errors
    /// If the journal or the result of the run cannot be read.
    pub(crate) fn report(&self, wall_s: f64) -> anyhow::Result<Report> {
        Ok(match self {
            Self::Calibration(run) => {
                report::calibration(&calibration_data(run, &recorded(run)?, wall_s)?)
            }
            Self::Diagnosis(run, loaded, found) => {
                let answer = DiagnosisOutput {
                    run,
                    loaded,
                    found,
                    wall_s,
                };
                report::diagnosis::report(&answer.subject()?)
            }
            Self::Identification(run, found) => {
                report::identification::report(&identification_data(run, found, wall_s)?)
            }
        })
    }

    /// Writes the result files of the run and prints its result.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub(crate) fn write(self, output: Output) -> anyhow::Result<()> {
        match self {
            Self::Calibration(run) => show(run, run.manifest.wall_s, output),
            Self::Diagnosis(run, loaded, mut found) => {
                restore_times(run, &mut found)?;
                let answer = DiagnosisOutput {
                    run,
                    loaded: &loaded,
                    found: &found,
                    wall_s: run.manifest.wall_s,
                };
                let object = answer.write()?;
                answer.print(output, &object)
            }
            Self::Identification(run, found) => {
                identified(run, &found, run.manifest.wall_s, output)
            }
        }
    }
}

/// Replaces the times of a diagnosis's stages, which reading takes, by those of the session that computed.
pub(crate) fn restore_times(run: &Diagnosis, found: &mut diagnosis::Found) -> anyhow::Result<()> {
    let known: Times = run.folder.read_json(RESULT)?;
    known.restore(&mut found.diagnosed.accounts);
    Ok(())
}
