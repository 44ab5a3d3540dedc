//! Work of an identifiability analysis: its settings and its execution.
use super::{
    diagnosis::{basin_search_preset, inputs},
    manifest::{self, IDENTIFY, Manifest},
    opened::Run,
};
use crate::cli::output::problem::Problem;
use case::Loaded;
use discrepancy::{
    diagnose::Inputs, identify::IdentificationResult, laboratory::Stage, thresholds::Thresholds,
};
use serde::{Deserialize, Serialize};
use study::{self, Evaluator, StageCost, StageView, Stop, Watch};

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

/// Results of an identifiability analysis.
pub(crate) struct Found {
    /// Notes about the case and its records.
    pub(crate) notes: Vec<String>,
    /// Result of the analysis: identifiability of the unknowns, and prediction bands.
    pub(crate) identified: IdentificationResult,
    /// Number and time of the simulations, for each stage that ran any.
    pub(crate) accounts: Vec<(Stage, StageCost)>,
}

/// Requests the library of instrument effects from the workers and runs the identifiability analysis.
///
/// # Errors
/// If no fit completes near the start; otherwise as [`study::identify_on`].
pub(crate) async fn identify<E: Evaluator>(
    evaluator: &mut E,
    manifest: &Manifest<IdentificationSettings>,
    loaded: &Loaded,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<Found> {
    let library = study::library(evaluator, stop).await?;
    let notes = study::check_records(evaluator, &loaded.case, &loaded.cycles, stop).await?;
    watch.noted(&notes);
    let notes = [&manifest.notes[..], &notes].concat();
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
    let Some(identified) = done.identified else {
        return Err(Problem {
            message: "no fit of this record completes, so the identifiability of the unknowns cannot be assessed"
                .to_owned(),
            remedy: "`horsehead simulate` says whether the case runs at all; start from parameters that \
                   do with --genes FILE, or take `held_out` from a channel of the calibrated condition"
                .to_owned(),
        }
        .into());
    };
    Ok(Found {
        notes,
        identified,
        accounts: done.accounts,
    })
}
