//! Results of an identifiability analysis, as data.
use crate::estimate::nuisances::NuisanceEstimate;
use record::Curves;
use record::noise::NoiseSource;
use serde::{Deserialize, Serialize};

/// Identifiability of a model's unknowns from a record.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct IdentificationResult {
    /// Fitted values of the unknowns \[declared units\], in the case's order.
    pub genes: Vec<f64>,
    /// Estimates of all fitted unknowns.
    pub unknowns: Vec<UnknownEstimate>,
    /// Eigenvectors of the Fisher information of the unknowns, best determined first.
    pub directions: Vec<Direction>,
    /// Estimated errors of the instruments, such as gains and delays.
    pub nuisances: Vec<NuisanceEstimate>,
    /// Predicted curves of the fit with their 95 % bands, by condition.
    pub bands: Vec<Band>,
    /// Further measurements that would determine unknowns, most informative first.
    pub further: Vec<FurtherMeasurement>,
    /// Whether unknowns have intervals: not where the fit leaves a multiple of the noise, because a model that lacks
    /// something has values of its own.
    pub has_intervals: bool,
    /// Squared residual of the fit divided by that expected of noise alone.
    pub left: f64,
    /// Whether the residual may be noise alone.
    pub is_noise: bool,
    /// Source of the noise level of the fitted record: scatter of cycles, stated, or guessed.
    pub noise: NoiseSource,
    /// Further remarks for the user.
    pub notes: Vec<String>,
}

/// Estimate of an unknown, with its profile likelihood.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnknownEstimate {
    /// Name of the unknown.
    pub name: String,
    /// Unit of the unknown.
    pub unit: String,
    /// Most likely value of the unknown.
    pub value: f64,
    /// Lower and upper end of the unknown's 95 % interval, where the profile rises by 3.84; `None` for an
    /// open end.
    pub interval: [Option<f64>; 2],
    /// How the profile ends on the lower and on the upper side: risen, bound reached, failed or given up.
    pub ends: [IntervalEnd; 2],
    /// Sides (lower, upper) on which the record bounds the unknown.
    pub seen: Determination,
    /// Names of other unknowns whose estimates are strongly correlated with this one, with the correlations.
    pub correlated: Vec<(String, f64)>,
    /// Profile likelihood: pairs of value and rise of `-2 ln L` with all other unknowns refitted, sorted by
    /// value.
    pub profile: Vec<[f64; 2]>,
}

/// Sides on which a record bounds an unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Determination {
    /// The record bounds the unknown on both sides.
    Both,
    /// The record bounds the unknown below only.
    LowerBound,
    /// The record bounds the unknown above only.
    UpperBound,
    /// The record bounds the unknown on neither side.
    NotSeen,
}

impl Determination {
    /// Returns on which sides an unknown is bounded, given whether its profile rises below and above the
    /// estimate.
    pub const fn of(below: bool, above: bool) -> Self {
        match (below, above) {
            (true, true) => Self::Both,
            (true, false) => Self::LowerBound,
            (false, true) => Self::UpperBound,
            (false, false) => Self::NotSeen,
        }
    }
}

/// Way in which one side of a profile likelihood ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IntervalEnd {
    /// The profile rises by 3.84 in `-2 ln L`, which is the end of a 95 % interval.
    Rises,
    /// The bound of the search is reached before the profile has risen by 3.84.
    Bound,
    /// Simulations fail before the profile has risen by 3.84: a limit of the model, not of the record.
    Fails,
    /// The maximum number of computed points is reached before the profile has risen by 3.84.
    GivenUp,
    /// The profile was not followed, because the fit leaves a multiple of the noise.
    NotFollowed,
}

/// Eigenvector of the Fisher information: a combination of unknowns that is determined independently of all
/// others.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Direction {
    /// Standard deviation along the direction: decades, or half-widths of the search interval for unknowns on
    /// a linear scale; infinite where the record does not determine the direction.
    pub sd_decades: f64,
    /// Components of the direction's unit vector along the unknowns, largest first.
    pub parts: Vec<DirectionPart>,
    /// Description of the combination of unknowns in words.
    pub words: String,
}

/// Component of one unknown in a direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DirectionPart {
    /// Name of the unknown.
    pub name: String,
    /// Component of the direction's unit vector along the unknown.
    pub part: f64,
}

/// Predicted curves of all channels under one condition, with 95 % bands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Band {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Predicted curves of the condition's channels, in order.
    pub channels: Vec<BandCurve>,
}

/// Predicted curve with its 95 % band.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BandCurve {
    /// Curve at the most likely values of the unknowns.
    pub likeliest: Vec<f64>,
    /// Lower limit of the 95 % band at each abscissa point.
    pub low: Vec<f64>,
    /// Upper limit of the 95 % band at each abscissa point.
    pub high: Vec<f64>,
}

impl BandCurve {
    /// Returns the mean half-width of the band, in the channel's unit.
    pub fn half_width(&self) -> f64 {
        let widths = self
            .low
            .iter()
            .zip(&self.high)
            .map(|(low, high)| high - low);
        0.5 * widths.sum::<f64>() / self.low.len().max(1) as f64
    }
}

/// Possible further measurement, and the unknowns that it would determine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FurtherMeasurement {
    /// Description of the measurement.
    pub measurement: String,
    /// Unknowns whose standard deviation the further measurement would at least halve, strongest reduction
    /// first.
    pub pins: Vec<DeterminedUnknown>,
}

/// Unknown that a further measurement would determine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeterminedUnknown {
    /// Name of the unknown.
    pub name: String,
    /// Standard deviation of the unknown with the present record (decades, or half-widths of the interval on
    /// a linear scale).
    pub sd_now: f64,
    /// Standard deviation of the unknown if the measurement is added to the record, in the same unit.
    pub sd_then: f64,
}

/// Simulated curves under a condition, with their derivatives by every variable of a fit, for prediction
/// bands.
#[derive(Clone, Debug)]
pub(crate) struct Sensitivity {
    pub(crate) condition: usize,
    /// Curves of all channels of the condition at the fit.
    pub(crate) curves: Curves,
    /// Changes of the curves per unit of each variable of the fit; `None` where the change is unknown.
    pub(crate) changes: Vec<Option<Curves>>,
    /// Curves of the same channels at other points that are compatible with the record.
    pub(crate) others: Vec<Curves>,
}
