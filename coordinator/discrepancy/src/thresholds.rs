//! Thresholds of a diagnosis, fixed before any record is seen.
use crate::laboratory::Stage;
use serde::{Deserialize, Serialize};

/// How a diagnosis decides. The defaults are those of every published result.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Thresholds {
    /// Highest order of a period that is compared.
    pub orders: usize,
    /// Level of the family of all effects' tests.
    pub alpha: f64,
    /// Level of the test that nothing at all is left: below it a record without a name is unresolved.
    pub adequacy: f64,
    /// Misfit from which a fit is suspected to lie outside the valley that the case describes.
    pub valley: f64,
    /// Suspects that are refitted with all unknowns free at a time, the likeliest first: all whose own test speaks for
    /// them, as far as a round's share of the budget for refits allows.
    pub suspects: usize,
    /// Nats of log evidence, over the dispersion, that an effect must gain to be believed: odds of 20 to 1.
    pub gain: f64,
    /// Nats of the predictive score (`proof::predictive`) that a name needs on all records together that took no part
    /// in the fit, and below whose negative none of them may lie. A name that is not there reaches `ln 20` in at most
    /// one of twenty diagnoses, whatever was searched on the fitted record.
    pub prediction: f64,
    /// Share of the gap before anything was added that an effect must remove to be more than a trace, where the model
    /// without it leaves no more than noise.
    pub practical: f64,
    /// Effects that are added at most.
    pub rounds: usize,
    /// Factor by which a form of force without a cause must beat the best name.
    pub generic_factor: f64,
    /// Units of `chi^2`, over the dispersion, by which it must beat it besides.
    pub generic_gain: f64,
    /// Squared cosine of projected signatures from which a form of force is a name's own.
    pub alike: f64,
    /// Noise sets that the map along the abscissa is held against.
    pub draws: usize,
    /// Longest step of all experiments, as a share of the case's: what is enough for a search is
    /// seen beside averaged noise.
    pub step: f64,
    /// Size of the elements of the numerical check, as a share of the case's. The fits keep the case's:
    /// what a finer model changes counts as noise.
    pub refinement: f64,
    /// Plain simulations after which a stage begins nothing more that it could do without, in the stages'
    /// order; one with derivatives counts as five, and a tenth for each.
    pub budget: [u32; Stage::ALL.len()],
    /// Effects that are not considered.
    pub without: Vec<String>,
}

/// Nats of log evidence, over the dispersion, and of predictive scores together, within which names are not told apart:
/// odds of 20 to 1, from which on evidence is called strong (Kass & Raftery 1995).
pub const SET: f64 = 3.0;

/// Names that may be equally likely and still be an answer: beyond, the joint or the order that they have in common is
/// all that is known.
pub(crate) const MOST_NAMES: usize = 4;

/// Standard deviations from what an instrument is good to within which it is no discovery: one in 370 lies beyond by
/// chance, and a machine has a dozen instruments.
pub const WITHIN: f64 = 3.0;

/// Largest factor by which noise variances from few cycles are widened: that of six degrees of freedom. Fewer have a
/// variance of hardly any meaning, or none.
pub(crate) const WIDEST: f64 = 1.5;

/// Share of the gain of evidence of the likeliest from which a rival is ranked with it: what explains less of the fitted
/// record does not explain enough of another to make up for that.
pub(crate) const RANKED: f64 = 0.5;

/// Standard deviations from which an instrument that a fit without effects takes so far off is a sign that something else
/// is missing: one in 16,000 lies beyond by chance. Instruments are then held within [`WITHIN`].
pub(crate) const BEYOND: f64 = 4.0;

/// Share of its range within which a size stands at a bound: less than any step of a fit.
pub(crate) const AT_BOUND: f64 = 1e-3;

/// Tail probability of Bartlett's test below which what is left is coloured, and intervals grow by what that costs: one
/// white record in a hundred has intervals that are too wide.
pub(crate) const COLOURED: f64 = 0.01;

/// Share of what is left that one more step of a converged fit may promise to remove. What lies below is taken off by
/// the tests themselves, which look at the residual after that step.
pub(crate) const PROMISED: f64 = 0.1;

/// Factor by which the variance of a data sheet may be off, either way: a noise that is stated in one figure is rarely
/// better known. Beyond, what is left is no noise, or not the noise that was stated.
pub(crate) const STATED: f64 = 2.0;

/// Squared distance of two effects, over the dispersion, from which they are told apart: the likelihood ratio of 1 in
/// 250 at even odds (DISCOVERY: isolability).
pub const APART: f64 = 11.0;

/// Share of false entries that a map of where simulation and measurement part may hold (Benjamini & Hochberg).
pub(crate) const MAPS: f64 = 0.05;

/// Share of the best joint's log Bayes factor within which joints are not told apart: latent forces along one load path
/// look nearly alike, and the right joint was within a tenth of the best in all of a simulated set.
pub(crate) const JOINTS: f64 = 0.1;

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
            practical: 0.05,
            rounds: 3,
            generic_factor: 1.15,
            generic_gain: 10.0,
            alike: 0.9,
            draws: 400,
            step: 0.7,
            refinement: 0.5,
            budget: [2000, 1200, 100, 200, 2000, 2400, 400],
            without: Vec::new(),
        }
    }
}
