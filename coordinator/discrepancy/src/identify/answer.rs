//! Results of an identifiability analysis, as data.
use crate::record::measured::Curves;
use crate::record::noise::Known;
use crate::size::never_exact::NeverExact;
use serde::{Deserialize, Serialize};

/// Identifiability of a model's unknowns from a record.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// The fitted individual \[declared units\], in the case's order.
    pub genes: Vec<f64>,
    /// Estimates of all fitted unknowns.
    pub unknowns: Vec<UnknownEstimate>,
    /// Eigenvectors of the Fisher information of the unknowns, best determined first.
    pub directions: Vec<Direction>,
    /// Estimated errors of the instruments.
    pub nuisances: Vec<NeverExact>,
    /// Predictions of the fit, by condition.
    pub bands: Vec<Band>,
    /// Further measurements that would determine unknowns, most informative first.
    pub further: Vec<Further>,
    /// Squared residual of the fit divided by that expected of noise alone.
    pub left: f64,
    /// Whether the residual may be noise alone.
    pub is_noise: bool,
    /// Source of the noise level.
    pub noise: Known,
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
    /// Most likely value.
    pub value: f64,
    /// Lower and upper end of the 95 % interval, where the profile rises by 3.84; `None` for an open end.
    pub interval: [Option<f64>; 2],
    /// Type of end of the profile on the lower and the upper side.
    pub ends: [End; 2],
    /// Sides on which the record bounds the unknown.
    pub seen: Seen,
    /// Names of strongly correlated unknowns, with the correlations.
    pub correlated: Vec<(String, f64)>,
    /// Profile likelihood: pairs of value and rise of `-2 ln L` with all other unknowns refitted, sorted by
    /// value.
    pub profile: Vec<[f64; 2]>,
}

/// Sides on which a record bounds an unknown.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Seen {
    /// Bounded on both sides.
    Both,
    /// Bounded below only.
    LowerBound,
    /// Bounded above only.
    UpperBound,
    /// Bounded on neither side.
    NotSeen,
}

impl Seen {
    /// Creates the value from the sides on which the profile rises.
    pub const fn of(below: bool, above: bool) -> Self {
        match (below, above) {
            (true, true) => Self::Both,
            (true, false) => Self::LowerBound,
            (false, true) => Self::UpperBound,
            (false, false) => Self::NotSeen,
        }
    }
}

/// Type of end of one side of a profile likelihood.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// The profile rises by 3.84.
    Rises,
    /// The bound of the search is reached before the profile has risen by 3.84.
    Bound,
    /// Simulations fail before the profile has risen by 3.84: a limit of the model, not of the record.
    Fails,
    /// The maximum number of points is reached before the profile has risen by 3.84.
    GivenUp,
}

/// Eigenvector of the Fisher information: a combination of unknowns that is determined independently of all
/// others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Direction {
    /// Standard deviation along the direction: decades, or half-widths of the search interval for unknowns on
    /// a linear scale; infinite where the record does not determine the direction.
    pub sd_decades: f64,
    /// Unknowns with their components of the unit vector, largest first.
    pub parts: Vec<Part>,
    /// Description in words.
    pub words: String,
}

/// Component of one unknown in a direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Name of the unknown.
    pub name: String,
    /// Component of the unit vector.
    pub part: f64,
}

/// What is predicted under a condition: 95 % bands of the simulated channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Predicted curves of the condition's channels, in order.
    pub channels: Vec<Curve>,
}

/// Predicted curve with its 95 % band.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Most likely curve.
    pub likeliest: Vec<f64>,
    /// Lower end of the band.
    pub low: Vec<f64>,
    /// Upper end of the band.
    pub high: Vec<f64>,
}

impl Curve {
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
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Further {
    /// Description of the measurement.
    pub measurement: String,
    /// Unknowns whose standard deviation the measurement would at least halve, strongest reduction first.
    pub pins: Vec<Pin>,
}

/// Unknown that a further measurement would determine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pin {
    /// Name of the unknown.
    pub name: String,
    /// Present standard deviation (decades, or half-widths of the interval on a linear scale).
    pub sd_now: f64,
    /// Standard deviation if the measurement is added to the record.
    pub sd_then: f64,
}

/// Curves under a condition, and their derivatives by every variable of a fit.
#[derive(Clone, Debug)]
pub(crate) struct Sight {
    pub(crate) condition: usize,
    /// Curves of all channels of the condition at the fit.
    pub(crate) curves: Curves,
    /// Changes of the curves per unit of each variable; `None` where the change is unknown.
    pub(crate) changes: Vec<Option<Curves>>,
    /// Curves of the same channels at other points that are compatible with the record.
    pub(crate) others: Vec<Curves>,
}
