//! Thresholds of a diagnosis, fixed before any record is seen.
use crate::laboratory::Stage;
use serde::{Deserialize, Serialize};
use std::num::NonZeroU32;

/// Decision thresholds of a diagnosis. The defaults are those of every published result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thresholds {
    /// Highest order of a period that is compared.
    pub orders: usize,
    /// Family-wise level of the tests of all effects.
    pub alpha: f64,
    /// Level of the test that only noise is left: below this p-value a record to which no effect is assigned
    /// is unresolved.
    pub adequacy: f64,
    /// Misfit from which a fit is suspected to lie outside the narrow minimum (valley) that the case
    /// describes.
    pub valley: f64,
    /// Number of candidate effects that are refitted at a time with all unknowns free, the most likely first:
    /// all whose own test is significant, as far as a round's share of the budget for refits allows.
    pub suspects: usize,
    /// Gain of log evidence (nats, over the dispersion) over a smooth discrepancy that an effect needs to be
    /// accepted: odds of 20 to 1. With it, one of 200 records of a linear model gets a false name at model errors of
    /// 0.6 to 3 standard errors (`predictive/tests/toy.rs`).
    pub gain: f64,
    /// Predictive score (nats, [`predictive`](crate::validation::predictive)) that an effect needs on all records together that took no
    /// part in the fit; no single record may score below its negative. An effect that is absent reaches `ln
    /// 20` in at most one of twenty diagnoses, however the effect was selected on the fitted record.
    pub prediction: f64,
    /// Maximum number of effects that a diagnosis adds to the model, one per round of tests.
    pub rounds: usize,
    /// Squared cosine of projected signatures from which a probe force counts as the same as a listed effect.
    pub alike: f64,
    /// Number of noise sets for the null distribution of the map along the abscissa.
    pub draws: usize,
    /// Longest integration step of all simulations, as a share of the case's: a step that is accurate enough
    /// for a search has errors that exceed averaged noise.
    pub step: f64,
    /// Element size in the numerical check, as a share of the case's. The fits keep the case's element size;
    /// the change by the finer model counts as noise.
    pub refinement: f64,
    /// Budget of each stage in plain simulations, in the stages' order, for a case of ten unknowns whose
    /// simulator computes derivatives, a hundred candidate effects and two conditions; it grows with each
    /// ([`Inputs::budget`](crate::inputs::Inputs::budget)). Once it is used up, a stage starts nothing that is
    /// optional. A simulation with derivatives counts as five, plus a tenth per derivative.
    pub budget: [u32; Stage::ALL.len()],
    /// Total budget of all stages in plain simulations, as the case states it, in which each stage has its share
    /// of `budget`; `None` for the budget that grows with the case.
    #[serde(default)]
    pub simulations: Option<NonZeroU32>,
    /// Identifiers of library effects that the diagnosis does not consider.
    pub without: Vec<String>,
}

/// Ratio of residual to noise from which a fit counts as one of a model that lacks something, whose unknowns
/// get no intervals: calibrations against records of the shipped machine without a hidden effect leave 1.1 to
/// 1.3 times the noise, those against the shipped record 4.9 to 7.5 times. There the interval of one
/// coefficient from the same record was 1.96 to 2.06e6 N/m before the missing effect was found, and 9e5 to 1.9e8
/// N/m after.
pub const NOISE_RATIO_LIMIT: f64 = 1.5;

/// Margin within which effects are not told apart, in nats of log evidence over the dispersion plus
/// predictive score: odds of 20 to 1, from which on evidence is called strong (Kass & Raftery 1995).
pub const AMBIGUITY_MARGIN: f64 = 3.0;

/// Largest number of equally likely effects that still count as an answer: with more, only their common joint
/// or order is reported.
pub(crate) const MOST_NAMES: usize = 4;

/// Prior standard deviations within which an instrument's error is no discovery: one in 370 lies beyond by
/// chance, and a machine has a dozen instruments.
pub const WITHIN: f64 = 3.0;

/// Error that every model of a real machine has in every channel, as a share of the root mean square of the measured
/// curve. Linearity and hysteresis of good measuring chains alone are 0.1 % (accuracy class 0.1).
pub(crate) const MODEL_FLOOR: f64 = 1e-3;

/// Error of the laws of effects that were found, as a share of what they change: real friction, losses and lags follow
/// idealised laws no better. Beside the friction of the shipped record, whose law is not the library's, a second
/// effect gains 9.9 nats and changes less than that.
/// The square is the share of their gain of evidence that such an error may cost.
pub(crate) const LAW_FLOOR: f64 = 0.05;

/// Prior standard deviations beyond which an instrument's error in a fit without effects indicates that
/// something else is missing: one in 16,000 lies beyond by chance. Instruments are then held within
/// [`WITHIN`].
pub(crate) const BEYOND: f64 = 4.0;

/// Share of the gap to every record that an answer must explain whose fit needs instruments beyond [`BEYOND`], and
/// share of the misfit beyond noise that each of several effects must explain where the answer leaves more than noise:
/// with less, what is missing beside it is larger than what is named. In practice set 2, whose resonance the slip of the
/// motor leaves open, a friction of 294 N.m where 56 N.m is hidden explains a third.
pub(crate) const MAJORITY: f64 = 0.5;

/// Distance to a bound, as a share of the range, within which a size counts as being on the bound: less than
/// any step of a fit.
pub(crate) const AT_BOUND: f64 = 1e-3;

/// Level of Bartlett's test for a coloured residual, which widens the intervals: one white record in a
/// hundred gets intervals that are too wide.
pub(crate) const COLOURED: f64 = 0.01;

/// Share of `chi^2` that one more step of a converged fit may still promise to remove. The tests remove a
/// smaller remainder themselves, since they use the residual after that step.
pub(crate) const MAX_PREDICTED_DECREASE: f64 = 0.1;

/// Squared distance of two effects, over the dispersion, from which they are told apart: a likelihood ratio
/// of 1 in 250 at even odds.
pub const APART: f64 = 11.0;

/// Share of false entries allowed in a map of the disagreement between simulation and measurement (Benjamini
/// & Hochberg).
pub(crate) const MAPS: f64 = 0.05;

/// Share of the best joint's log Bayes factor within which joints are not told apart: latent forces along one load path
/// look nearly alike, and the right joint was within a tenth of the best in all of a simulated set.
pub(crate) const JOINTS: f64 = 0.1;

impl Thresholds {
    /// Returns the gain of log evidence (nats) that `effects` effects out of `tried` candidates need where no other
    /// record tests their laws: the best of many candidates has `ln(tried)` more by chance.
    pub(crate) fn evidence_of_best(&self, tried: usize, effects: usize) -> f64 {
        self.prediction + libm::log(tried.max(1) as f64) * effects as f64
    }
}

impl Default for Thresholds {
    fn default() -> Self {
        Self {
            orders: 120,
            alpha: 0.01,
            adequacy: 1e-3,
            valley: 3.0,
            suspects: 8,
            gain: 3.0,
            prediction: std::f64::consts::LN_2 + std::f64::consts::LN_10,
            rounds: 3,
            alike: 0.9,
            draws: 400,
            step: 0.7,
            refinement: 0.5,
            budget: [2000, 1200, 100, 200, 2000, 2400, 400],
            simulations: None,
            without: Vec::new(),
        }
    }
}
