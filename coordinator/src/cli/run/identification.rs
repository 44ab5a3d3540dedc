//! Work of an identifiability analysis: its settings and its execution.
use super::{
    diagnosis::{basin_search_preset, inputs},
    manifest::{self, IDENTIFY, Manifest},
    opened::Run,
};
use crate::cli::output::problem::Problem;
use case::Loaded;
use discrepancy::{diagnose::Inputs, thresholds::Thresholds};
use serde::{Deserialize, Serialize};
use study::{self, Entry, Evaluator, IdentificationStudy, StageView, Stop, Watch};

/// Identifiability analysis: run of `horsehead identify`.
pub(crate) type Identification = Run<IdentificationSettings>;

/// Settings that determine the result of an identifiability analysis, besides case, seed and start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct IdentificationSettings {
    /// Highest harmonic order of the period at which simulation and record are compared [1].
    pub(crate) orders: usize,
    /// Whether every derivative is a finite difference of whole simulations.
    pub(crate) differences: bool,
}

impl manifest::RunIdentity for IdentificationSettings {
    const KIND: &'static str = IDENTIFY;

    fn arguments(&self) -> String {
        if self.differences {
            " --differences".to_owned()
        } else {
            String::new()
        }
    }
}

/// Requests the library of instrument effects from the workers and runs the identifiability analysis; enters
/// records, notes and result.
///
/// # Errors
/// If no fit completes near the start; otherwise as [`study::identify_on`].
pub(crate) async fn identify<E: Evaluator>(
    evaluator: &mut E,
    manifest: &Manifest<IdentificationSettings>,
    loaded: &Loaded,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<()> {
    for record in Entry::records(&loaded.cycles) {
        evaluator.enter(&record)?;
    }
    let library = study::library(evaluator, stop).await?;
    let notes = study::check_records(evaluator, &loaded.case, &loaded.cycles, stop).await?;
    watch.noted(&notes);
    evaluator.enter(&Entry::Noted(notes.clone()))?;
    let own = &manifest.settings;
    let thresholds = Thresholds {
        orders: own.orders,
        ..Thresholds::default()
    };
    let case = &loaded.case;
    let inputs = Inputs {
        differences: own.differences,
        ..inputs(
            loaded,
            manifest,
            &thresholds,
            (library, basin_search_preset(case)),
        )?
    };
    let done = study::identify_on(evaluator, case, &inputs, watch, stop).await?;
    let Some(done) = done else {
        return Err(Problem {
            message: "no fit of this record completes, so the identifiability of the unknowns cannot be assessed"
                .to_owned(),
            remedy: "`horsehead simulate` says whether the case runs at all; start from parameters that \
                   do with --genes FILE, or take `held_out` from a channel of the calibrated condition"
                .to_owned(),
        }
        .into());
    };
    let done = IdentificationStudy { notes, ..done };
    Ok(evaluator.enter(&Entry::Identified(Box::new(done)))?)
}

/// Reads the result of a finished identifiability analysis from its journal.
///
/// # Errors
/// If the analysis is not finished, or its journal is missing or of another version.
pub(crate) fn recorded(run: &Identification) -> anyhow::Result<IdentificationStudy> {
    let read = study::read_identification(&run.expect_journal()?);
    let mut recorded = read.map_err(|error| run.unreadable(error))?;
    let of_case = run.manifest.notes.iter().cloned();
    recorded.notes.splice(..0, of_case);
    Ok(recorded)
}
