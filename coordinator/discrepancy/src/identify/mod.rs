//! Identifiability analysis: which unknowns and combinations of unknowns a record determines, and how the
//! undetermined ones affect predictions.
//!
//! The metric, the tolerances of the instruments and the numerical error are those of a diagnosis. Missing
//! effects are not considered: where the fit leaves more than noise, the intervals are widened, and a
//! diagnosis should follow.
pub mod answer;
mod band;
mod estimate;
mod further;
mod glance;
mod information;
mod profile;
mod refit;
mod settings;
mod walk;

pub use answer::{
    Band, Curve, Direction, End, Further, Identified, Part, Pin, Seen, UnknownEstimate,
};

pub use glance::glance;

use crate::ground::establish::establish;
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::model::experiments::Experiments;
use crate::model::unknowns::Unstated;
use crate::size::never_exact::never_exact;
use crate::size::spread::coloured;
use protocol::case::Channel;
use settings::FREE;

/// Fits the record of the calibrated condition and determines the identifiability of its unknowns.
/// `conditions` are the channels of every condition of the case, in its order. Returns `None` where no fit
/// completes or there is nothing to fit.
///
/// # Errors
/// Those of the laboratory: no worker is left, or the user stopped the run.
pub async fn identify<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    conditions: &[Vec<Channel>],
) -> Result<Option<Identified>, L::Error> {
    let record = inputs.records.first().filter(|record| record.is_fitted());
    let Some(record) = record else {
        return Ok(None);
    };
    let Ok(base) = establish(lab, inputs, record.free()).await? else {
        return Ok(None);
    };
    let mut experiments = Experiments {
        lab,
        on: &base.on,
        stage: Stage::Refit,
    };
    let mut start = base.fit.point();
    start.model.unstated = Unstated::Bounds;
    let Some(fit) = experiments.fit(start, FREE).await? else {
        return Ok(None);
    };
    let walked = walk::walk(&mut experiments, fit).await?;
    let fit = &walked.fit;
    let mut shown = experiments.during(Stage::Show);
    let sights = band::sights(&mut shown, &walked, conditions).await?;
    let spread = &walked.spread;
    let coloured: Vec<String> = spread.largest_growth().map(coloured).into_iter().collect();
    // less than the noise that was stated is nothing to explain
    let is_noise =
        fit.chi_squared() <= base.noise() || base.explains(fit, inputs.thresholds.adequacy);
    Ok(Some(Identified {
        genes: fit.model.genes(fit.x()),
        unknowns: estimate::estimates(&walked),
        directions: information::directions(fit, spread),
        nuisances: never_exact(fit, spread),
        bands: sights
            .iter()
            .map(|sight| band::band(&walked, sight))
            .collect(),
        further: further::further(&walked, &sights, (inputs, &base.on), conditions),
        left: fit.chi_squared() / base.noise(),
        is_noise,
        noise: base.known(),
        notes: [&base.notes[..], base.strained().as_slice(), &coloured[..]].concat(),
    }))
}
