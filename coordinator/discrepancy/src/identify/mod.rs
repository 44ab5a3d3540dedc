//! Identifiability analysis: which unknowns and combinations of unknowns a record determines, and how the
//! undetermined ones affect predictions.
//!
//! The metric, the tolerances of the instruments and the numerical error are those of a diagnosis. Missing
//! effects are not considered: where the fit leaves more than noise, the intervals are widened, and a
//! diagnosis should come first. Where it leaves a multiple of the noise there are none.
pub mod answer;
mod band;
mod estimate;
mod information;
mod linear_estimate;
mod measurement_proposals;
mod profile;
mod profiles;
mod refit;
mod settings;

pub use answer::{
    Band, BandCurve, Determination, DeterminedUnknown, Direction, DirectionPart,
    FurtherMeasurement, IdentificationResult, IntervalEnd, UnknownEstimate,
};

pub use linear_estimate::{LinearEstimate, linear_estimate, neighbourhood_at_start};

use crate::baseline::establish::establish;
use crate::estimate::nuisances::nuisance_estimates;
use crate::estimate::spread::{Spread, coloured};
use crate::inputs::Inputs;
use crate::laboratory::{Laboratory, Stage};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::unknowns::DefaultPrior;
use crate::thresholds::NOISE_RATIO_LIMIT;
use protocol::case::Channel;
use record::noise::NoiseSource;
use settings::FREE;

/// Growth of intervals by colour of the residual from which it counts as structure: of 200 white residuals of a straight
/// line one grows by a factor of 1.7, of noise with a correlation of 0.8 from sample to sample by a factor of 3.
const STRUCTURED: f64 = 2.0;

/// Fits the record of the calibrated condition and determines the identifiability of its unknowns.
/// `conditions` are the channels of every condition of the case, in its order. Returns `None` where no fit
/// completes or there is nothing to fit.
///
/// # Errors
/// Returns an error if no worker is left to simulate, or the user stops the run.
pub async fn identify<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    conditions: &[Vec<Channel>],
) -> Result<Option<IdentificationResult>, L::Error> {
    let record = inputs.records.first().filter(|record| record.is_fitted());
    let Some(record) = record else {
        return Ok(None);
    };
    let Ok(base) = establish(lab, inputs, record.free()).await? else {
        return Ok(None);
    };
    let mut experiments = Experiments {
        lab,
        on: &base.record,
        stage: Stage::Refit,
    };
    let mut start = base.fit.point();
    start.model.unstated = DefaultPrior::Bounds;
    let Some(fit) = experiments.fit(start, FREE).await? else {
        return Ok(None);
    };
    let (fit, others) = profiles::restarted(&mut experiments, fit).await?;
    // less than the noise that was stated is nothing to explain
    let is_noise = |fit: &Fit| {
        fit.chi_squared() <= base.noise() || base.explains(fit, inputs.thresholds.adequacy)
    };
    let left = |fit: &Fit| fit.chi_squared() / base.noise();
    // white residuals above a stated noise are noise that was stated wrongly
    let spread = Spread::of(&base.record.metric, &fit);
    let is_structure = base.known() != NoiseSource::Stated
        || spread
            .largest_growth()
            .is_some_and(|growth| growth > STRUCTURED);
    if is_structure && !is_noise(&fit) && left(&fit).sqrt() >= NOISE_RATIO_LIMIT {
        let instruments = base.instruments_beyond_tolerance();
        return Ok(Some(IdentificationResult {
            genes: fit.model.genes(fit.x()),
            unknowns: estimate::values(&fit),
            directions: Vec::new(),
            nuisances: Vec::new(),
            bands: Vec::new(),
            further: Vec::new(),
            has_intervals: false,
            left: left(&fit),
            is_noise: false,
            noise: base.known(),
            notes: [&base.notes[..], instruments.as_slice()].concat(),
        }));
    }
    let walked = profiles::walk(&mut experiments, fit, others).await?;
    let (fit, spread) = (&walked.fit, &walked.spread);
    let mut shown = experiments.for_stage(Stage::Show);
    let sights = band::sights(&mut shown, &walked, conditions).await?;
    let coloured: Vec<String> = spread.largest_growth().map(coloured).into_iter().collect();
    Ok(Some(IdentificationResult {
        genes: fit.model.genes(fit.x()),
        unknowns: estimate::estimates(&walked),
        directions: information::directions(fit, spread),
        nuisances: nuisance_estimates(fit, spread),
        bands: sights
            .iter()
            .map(|sight| band::band(&walked, sight))
            .collect(),
        further: measurement_proposals::further(
            &walked,
            &sights,
            (inputs, &base.record),
            conditions,
        ),
        has_intervals: true,
        left: left(fit),
        is_noise: is_noise(fit),
        noise: base.known(),
        notes: [
            &base.notes[..],
            base.instruments_beyond_tolerance().as_slice(),
            &coloured[..],
        ]
        .concat(),
    }))
}
