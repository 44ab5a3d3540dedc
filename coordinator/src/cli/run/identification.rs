//! The work of an identification: what decides it, and what the record sees.
use super::{
    begun::Run,
    diagnosis::{entrance, inputs},
    manifest::{self, IDENTIFY, Manifest},
};
use crate::cli::output::{problem::Problem, terminal};
use case::Loaded;
use discrepancy::{
    diagnose::Inputs, identify::Identified, laboratory::Stage, thresholds::Thresholds,
};
use serde::{Deserialize, Serialize};
use study::{self, Evaluator, StageCost, StageView, Stop, Watch};

/// An identification that was begun.
pub(crate) type Identification = Run<Decides>;

/// Everything that decides an identification beside case, seed and start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Decides {
    /// Highest order of a period that is compared.
    pub(crate) orders: usize,
    /// Whether every derivative is a difference of whole simulations.
    pub(crate) differences: bool,
}

impl manifest::Decides for Decides {
    const KIND: &'static str = IDENTIFY;

    fn arguments(&self) -> String {
        if self.differences {
            " --differences".to_owned()
        } else {
            String::new()
        }
    }
}

/// What an identification finds.
pub(crate) struct Found {
    /// What there is to know of the case and its records.
    pub(crate) notes: Vec<String>,
    /// The answer.
    pub(crate) identified: Identified,
    /// Stages that did experiments.
    pub(crate) accounts: Vec<(Stage, StageCost)>,
}

/// Learns which instruments the workers know, and identifies, on whatever evaluates.
///
/// # Errors
/// If nothing completes near the start; as [`study::identify_on`].
pub(crate) async fn identify<E: Evaluator>(
    evaluator: &mut E,
    manifest: &Manifest<Decides>,
    loaded: &Loaded,
    watch: &mut dyn Watch<StageView>,
    stop: &mut Stop,
) -> anyhow::Result<Found> {
    let library = study::library(evaluator, stop).await?;
    let notes = study::check_records(evaluator, &loaded.case, stop).await?;
    terminal::note(&notes);
    let notes = [&manifest.notes[..], &notes].concat();
    let own = &manifest.settings;
    let thresholds = Thresholds {
        orders: own.orders,
        ..Thresholds::default()
    };
    let case = &loaded.case;
    let inputs = Inputs {
        differences: own.differences,
        ..inputs(loaded, manifest, &thresholds, (library, entrance(case)))?
    };
    let done = study::identify_on(evaluator, case, &inputs, watch, stop).await?;
    let Some(identified) = done.identified else {
        return Err(Problem {
            message: "no fit of this record completes, so nothing can be said of what it sees"
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
