//! A diagnosis that was begun earlier: the same again, from its recording.
use super::{
    Output,
    answer::Answer,
    bus,
    diagnose::{Decides, diagnose},
    diagnosis_json, interrupt,
    problem::Usage,
    report::recording,
    run_folder::{DIAGNOSE, Manifest, RunFolder},
};
use crate::{
    case::{Loaded, Overrides, load_with_notes},
    study::{Crew, Diagnosed, Evaluator, Recorded, Stop, Watch},
};
use discrepancy::laboratory::Stage;
use protocol::{announce::EffectDescriptor, case::Case, event::Finished, job::Job};
use std::path::{Path, PathBuf};

/// What its folder says of a diagnosis.
pub(super) struct Earlier {
    pub(super) folder: RunFolder,
    pub(super) manifest: Manifest<Decides>,
    pub(super) case: Case,
}

impl Earlier {
    /// Opens its folder.
    pub(super) fn open(path: &Path) -> anyhow::Result<Self> {
        let (folder, manifest, case) = RunFolder::open::<Decides>(path, DIAGNOSE)?;
        Ok(Self {
            folder,
            manifest,
            case,
        })
    }

    /// The case with its records: a run keeps its case, but not the cycles of the records.
    pub(super) fn loaded(&self) -> anyhow::Result<Loaded> {
        let manifest = &self.manifest;
        let own = PathBuf::from(&manifest.measured);
        let replaced = std::path::absolute(&own)? != manifest.case_folder;
        let overrides = Overrides {
            measured: replaced.then_some(own),
        };
        let loaded = self.as_begun(load_with_notes(&manifest.case_folder, &overrides)?)?;
        if loaded.case != self.case {
            return Err(Usage {
                message: format!(
                    "the case has changed since {} was made, and its records are read anew",
                    self.folder.path().display()
                ),
                help: format!(
                    "put {} back as it was, or diagnose it again with another --run",
                    manifest.case_folder.display()
                ),
            }
            .into());
        }
        Ok(loaded)
    }

    /// A case without what this very diagnosis has added to it.
    pub(super) fn as_begun(&self, loaded: Loaded) -> anyhow::Result<Loaded> {
        Ok(loaded.without_found_in(&bus::case_hash(&self.case)?))
    }

    /// Diagnoses again, on what answers from a recording.
    pub(super) async fn repeat<E: Evaluator>(
        &self,
        evaluator: &mut E,
        loaded: &Loaded,
        watch: &mut dyn Watch,
        stop: &mut Stop,
    ) -> anyhow::Result<(Diagnosed, Vec<EffectDescriptor>)> {
        diagnose(evaluator, &self.manifest, loaded, watch, stop).await
    }
}

/// Writes the files of a finished diagnosis again, from its journal.
pub(super) fn report(path: &Path, output: Output) -> anyhow::Result<()> {
    let earlier = Earlier::open(path)?;
    let Earlier {
        folder, manifest, ..
    } = &earlier;
    folder.expect_replayable(manifest)?;
    let loaded = earlier.loaded()?;
    let recording = recording(folder)?;
    let mut unseen = |_: &Job, _: &Finished| Ok(());
    let mut recorded = Recorded::new(&recording, &mut unseen);
    let (mut diagnosed, library) = bus::block_on(async {
        let (mut watch, mut stop) = (Unwatched, interrupt::listen());
        earlier
            .repeat(&mut recorded, &loaded, &mut watch, &mut stop)
            .await
    })?;
    // reading takes a moment: the times are those of the session that computed
    let known: diagnosis_json::Times = folder.read_json("result.json")?;
    known.restore(&mut diagnosed.accounts);
    let answer = Answer {
        folder,
        manifest,
        loaded: &loaded,
        diagnosed: &diagnosed,
        library: &library,
        wall_s: manifest.wall_s,
    };
    let object = answer.write()?;
    answer.print(output, &object)
}

/// Shows nothing.
struct Unwatched;

impl Watch for Unwatched {
    fn progress(&mut self, _: Stage, _: u64, _: usize, _: &dyn Fn() -> Crew) {}
}
