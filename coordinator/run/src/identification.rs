//! Identifiability analysis: its settings, its work, its result as the journal states it, and the data of its report.
use crate::{
    diagnosis::{basin_search_preset, begin, inputs},
    manifest::{self, IDENTIFY, Manifest},
    opened::Run,
};
use case::Loaded;
use discrepancy::{diagnose::Inputs, thresholds::Thresholds};
use report::identification::IdentificationInput;
use serde::{Deserialize, Serialize};
use study::{self, Entry, Evaluator, IdentificationStudy, StageView, Stop, Watch};
use support::Problem;

/// Run of `horsehead identify`.
pub type IdentificationRun = Run<IdentificationSettings>;

/// Settings that determine the result of an identifiability analysis, besides case, seed and start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IdentificationSettings {
    /// Highest harmonic order of the period at which simulation and record are compared \[1\].
    pub orders: usize,
    /// Whether every derivative is a finite difference of whole simulations.
    pub differences: bool,
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
pub async fn identify<E: Evaluator>(
    evaluator: &mut E,
    manifest: &Manifest<IdentificationSettings>,
    loaded: &Loaded,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<()> {
    let (library, notes) = begin(evaluator, loaded, watch, stop).await?;
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
pub fn recorded(run: &IdentificationRun) -> anyhow::Result<IdentificationStudy> {
    let read = study::read_identification(&run.expect_journal()?);
    let mut recorded = read.map_err(|error| run.unreadable(error))?;
    let of_case = run.manifest.notes.iter().cloned();
    recorded.notes.splice(..0, of_case);
    Ok(recorded)
}

/// Builds the data of a finished identifiability analysis's report.
///
/// # Errors
/// If the case of the run cannot be encoded.
pub fn report_input<'a>(
    run: &'a IdentificationRun,
    found: &'a IdentificationStudy,
    wall_s: f64,
) -> anyhow::Result<IdentificationInput<'a>> {
    Ok(IdentificationInput {
        case: &run.case,
        identified: &found.identified,
        origin: run.origin(String::new())?,
        notes: &found.notes,
        wall_s,
    })
}
