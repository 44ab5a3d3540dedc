//! Target of a command that fits a model: a case folder, or a finished calibration whose case, records and
//! parameters are used.
use crate::{
    calibration::{CalibrationRun, recorded},
    diagnosis::{DiagnosisRun, DiagnosisSettings},
    folder::{GENES, RunFolder},
    manifest::{CALIBRATE, DIAGNOSE, Manifest, RunIdentity, StartPoint},
    name::RunName,
};
use case::{Loaded, Note, Overrides, difference::differences, load_with_notes, require_record};
use protocol::case::Case;
use search::strategy::family::rivals;
use std::path::{Path, PathBuf};
use support::Problem;

/// Case to fit, with its measured records and the places from which both were read.
pub struct StudyTarget {
    /// Folder of the case.
    pub folder: PathBuf,
    /// Folder of the measured records that replace those of the case; `None` for the case's own.
    pub measured: Option<PathBuf>,
    /// Case as read from its folder.
    pub loaded: Loaded,
    /// Values of the unknowns from which the recalibration starts; `None` for the recommended values.
    pub start: Option<StartPoint>,
    /// Words that distinguish a run on this target from others on its case: those of the calibration, or the start.
    words: Vec<String>,
    /// Seed of the calibration; 1 for a case folder.
    seed: u64,
}

impl StudyTarget {
    /// Reads a case folder, or a finished calibration with its case, records and parameters; explicitly named
    /// records and genes take precedence.
    ///
    /// # Errors
    /// If the case or a file cannot be read, the case has no record of the calibrated condition, or the run
    /// is of another kind or not finished.
    pub fn read(
        target: &Path,
        measured: Option<&Path>,
        genes: Option<&Path>,
    ) -> anyhow::Result<Self> {
        let folder = RunFolder::new(target);
        let (mut words, mut seed) = (Vec::new(), 1);
        let calibration = folder.is_begun().then(|| finished(&folder)).transpose()?;
        let (case, records, own) = if let Some(calibration) = &calibration {
            let manifest = &calibration.manifest;
            words = manifest.words()?;
            seed = manifest.seed;
            let records = manifest.replaced_records().map(ToOwned::to_owned);
            (
                manifest.case_folder.clone(),
                records,
                Some(folder.file(GENES)),
            )
        } else {
            (target.to_owned(), None, None)
        };
        let of_run = measured.is_none() && genes.is_none();
        let measured = measured.map(ToOwned::to_owned).or(records);
        let overrides = Overrides {
            measured: measured.clone(),
        };
        let mut loaded = load_with_notes(&case, &overrides)?;
        require_record(&case, &loaded.case, loaded.case.objective.condition)?;
        require_equalities(&loaded.case)?;
        let is_given = genes.is_some();
        let genes = genes.map(ToOwned::to_owned).or(own);
        let start = genes.map(|file| StartPoint::read(&file, &mut loaded));
        let mut start = start.transpose()?;
        if let (Some(start), Some(calibration), true) = (&mut start, &calibration, of_run) {
            start.families = families(calibration, &start.file, &mut loaded)?;
        }
        if let Some(start) = start.as_ref().filter(|_| is_given) {
            words = vec![start.word()?];
        }
        Ok(Self {
            folder: case,
            measured,
            loaded,
            start,
            words,
            seed,
        })
    }

    /// Returns the seed of a run on this target: the given one, or that of the calibration.
    pub fn seed(&self, given: Option<u64>) -> u64 {
        given.unwrap_or(self.seed)
    }

    /// Returns the default path of the run folder of a command on this target.
    ///
    /// # Errors
    /// As [`RunName::path`].
    pub fn run_path(&self, command: &str, seed: u64) -> anyhow::Result<PathBuf> {
        self.path_of(command, seed, &self.loaded.case)
    }

    /// Returns the default path of the run folder of an earlier diagnosis of this target that added the last effects of
    /// the case; `None` if there is none with these settings.
    ///
    /// # Errors
    /// If the case cannot be encoded, or a run of it cannot be read.
    pub fn earlier_path(
        &self,
        seed: u64,
        settings: &DiagnosisSettings,
    ) -> anyhow::Result<Option<PathBuf>> {
        let stated = &self.loaded.case.effects;
        for kept in 0..stated.len() {
            let mut case = self.loaded.case.clone();
            case.effects.truncate(kept);
            let path = self.path_of(DIAGNOSE, seed, &case)?;
            let Ok(earlier) = DiagnosisRun::open(&path) else {
                continue;
            };
            let is_same = earlier.manifest.settings == *settings;
            if is_same && earlier.as_begun(self.loaded.clone())?.effects.len() == kept {
                return Ok(Some(path));
            }
        }
        Ok(None)
    }

    fn path_of(&self, command: &str, seed: u64, case: &Case) -> anyhow::Result<PathBuf> {
        let name = RunName {
            case_folder: &self.folder,
            case,
            what: command,
            set: &self.words,
            measured: self.measured.as_deref(),
            seed,
        };
        name.path()
    }

    /// Creates the manifest of a new run on this target with the given seed and settings.
    ///
    /// # Errors
    /// As [`Manifest::new`].
    pub fn manifest<S: RunIdentity>(&self, seed: u64, settings: S) -> anyhow::Result<Manifest<S>> {
        let measured = self.measured.as_ref().unwrap_or(&self.folder);
        let notes = self.loaded.notes.iter().map(ToString::to_string);
        Ok(Manifest {
            start: self.start.clone(),
            measured: measured.display().to_string(),
            synthetic: self.loaded.synthetic,
            notes: notes.collect(),
            effects: self.loaded.effects.clone(),
            ..Manifest::new(&self.folder, seed, settings)?
        })
    }

    /// Removes the effects that an earlier session of this diagnosis added to the case, and restricts the
    /// start to the remaining unknowns.
    ///
    /// # Errors
    /// If the case cannot be encoded, or the run holds other unknowns.
    pub fn without_additions_of(mut self, earlier: &DiagnosisRun) -> anyhow::Result<Self> {
        let stated = self.loaded.case.unknowns.clone();
        self.loaded = earlier.as_begun(self.loaded)?;
        let left = &self.loaded.case.unknowns;
        let kept = |values: Vec<f64>| {
            let pairs = stated.iter().zip(values);
            let kept = pairs.filter(|(gene, _)| left.contains(gene));
            kept.map(|(_, value)| value).collect()
        };
        if let Some(start) = &self.start {
            // they were told of a case that had the additions
            let of_start =
                |path: &Path| std::path::absolute(path).is_ok_and(|path| path == start.file);
            self.loaded.notes.retain(|note| !of_start(&note.path));
        }
        let families = earlier.manifest.families().map(<[Vec<f64>]>::to_vec);
        self.start = self.start.map(|start| StartPoint {
            genes: kept(start.genes),
            families,
            ..start
        });
        Ok(self)
    }
}

/// Checks that no channel of a case is a limit: whether a residual exceeds the noise cannot be asked of values that the
/// model need not meet.
fn require_equalities(case: &Case) -> Result<(), Problem> {
    let mut limits = case.channels.iter().filter(|own| own.limit.is_some());
    limits.next().map_or(Ok(()), |channel| {
        Err(Problem {
            message: format!(
                "channel `{}` is a limit, which `diagnose` and `identify` cannot use",
                channel.name
            ),
            remedy: "work on a copy of the case without its channels with `limit`, and without their terms of the objective"
                .to_owned(),
        })
    })
}

/// Number of fits of other families that a recalibration starts from beside the optimum.
const FAMILIES: usize = 2;

/// Returns the best fits of other families that a calibration saw, whose optimum is in the gene file `start`; `None`,
/// with a note on that file, where its case or records are not those of today; `None` if no descent of its search
/// converged.
fn families(
    calibration: &CalibrationRun,
    start: &Path,
    loaded: &mut Loaded,
) -> anyhow::Result<Option<Vec<Vec<f64>>>> {
    let mut note = |text: String| {
        loaded.notes.push(Note {
            path: start.to_owned(),
            text,
        });
    };
    let changes = differences(&calibration.case, &loaded.case);
    if !changes.is_empty() {
        note(format!(
            "the optimum of the run alone is used, because the case has changed since: {changes}"
        ));
        return Ok(None);
    }
    let found = match recorded(calibration) {
        Ok(recorded) => recorded.result.calibrated,
        Err(error) => {
            note(format!("the optimum of the run alone is used: {error}"));
            return Ok(None);
        }
    };
    if found.descent_ends.is_empty() {
        return Ok(None);
    }
    let space = calibration.manifest.space(&calibration.case)?;
    let best = (&found.best.genes[..], found.best.fitness);
    let others = rivals(&space, best, &found.descent_ends, |_| true);
    let genes = others.into_iter().take(FAMILIES);
    Ok(Some(genes.map(|own| own.end.genes.clone()).collect()))
}

/// Opens the calibration in a run folder and checks that it is finished.
fn finished(folder: &RunFolder) -> anyhow::Result<CalibrationRun> {
    let path = folder.path();
    let kind = folder.head()?.kind;
    if kind != CALIBRATE {
        return Err(Problem {
            message: format!("{} holds a run of `horsehead {kind}`", path.display()),
            remedy: "name a case folder, or the folder of a calibration".to_owned(),
        }
        .into());
    }
    let calibration = CalibrationRun::open(path)?;
    calibration.expect_parameters()?;
    Ok(calibration)
}
