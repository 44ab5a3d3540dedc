//! Which kind of run a folder holds: asked here, and nowhere else.
use super::{
    begun::Run,
    calibration::{self, Calibration, calibrate},
    diagnosis::{self, Diagnosis, diagnose},
    folder::{RESULT, RunFolder},
    identification::{self, Identification, identify},
    manifest::{CALIBRATE, DIAGNOSE, IDENTIFY},
};
use crate::cli::{
    argument::output::Output,
    output::{
        calibration::show, diagnosis::Answer, identification::show as identified,
        object::diagnosis::times::Times, problem::Problem,
    },
};
use case::Loaded;
use std::path::Path;
use study::{Evaluator, ProgressView, StageView, Stop, Watch};

/// A run that was begun, of either kind.
pub(crate) enum AnyRun {
    /// Of `horsehead calibrate`.
    Calibration(Calibration),
    /// Of `horsehead diagnose`.
    Diagnosis(Diagnosis),
    /// Of `horsehead identify`.
    Identification(Identification),
}

/// A run with what it found, repeated from its journal.
pub(crate) enum Repeated<'a> {
    /// A calibration.
    Calibration(&'a Calibration, calibration::Found),
    /// A diagnosis, with the case and the records that it read anew.
    Diagnosis(&'a Diagnosis, Box<Loaded>, Box<diagnosis::Found>),
    /// An identification.
    Identification(&'a Identification, Box<identification::Found>),
}

impl AnyRun {
    /// Opens a run that was begun before.
    ///
    /// # Errors
    /// If the folder holds none, or one that this version does not know.
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

    /// Makes sure that the run can be replayed: it is finished and its journal is there.
    ///
    /// # Errors
    /// If not; the error says how to go on.
    pub(crate) fn expect_replayable(&self) -> Result<(), Problem> {
        match self {
            Self::Calibration(run) => run.expect_replayable(),
            Self::Diagnosis(run) => run.expect_replayable(),
            Self::Identification(run) => run.expect_replayable(),
        }
    }

    /// Does the same again, on what answers from a recording.
    ///
    /// # Errors
    /// If the recording does not hold everything that the run asks for.
    pub(crate) async fn repeat<E: Evaluator>(
        &self,
        evaluator: &mut E,
        watch: &mut (impl Watch<ProgressView> + Watch<StageView>),
        stop: &mut Stop,
    ) -> anyhow::Result<Repeated<'_>> {
        Ok(match self {
            Self::Calibration(run) => {
                Repeated::Calibration(run, calibrate(evaluator, run, watch, stop).await?)
            }
            Self::Diagnosis(run) => {
                let loaded = Box::new(run.loaded()?);
                let found = diagnose(evaluator, &run.manifest, &loaded, watch, stop).await?;
                Repeated::Diagnosis(run, loaded, Box::new(found))
            }
            Self::Identification(run) => {
                let loaded = run.loaded()?;
                let found = identify(evaluator, &run.manifest, &loaded, watch, stop).await?;
                Repeated::Identification(run, Box::new(found))
            }
        })
    }
}

impl Repeated<'_> {
    /// Writes its files, and prints its result.
    ///
    /// # Errors
    /// If a file cannot be written.
    pub(crate) fn write(self, output: Output) -> anyhow::Result<()> {
        match self {
            Self::Calibration(run, found) => show(run, &found, run.manifest.wall_s, output),
            Self::Diagnosis(run, loaded, mut found) => {
                // reading takes a moment: the times are those of the session that computed
                let known: Times = run.folder.read_json(RESULT)?;
                known.restore(&mut found.diagnosed.accounts);
                let answer = Answer {
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
