//! What a record sees: the answer as data.
use crate::record::measured::Curves;
use crate::record::noise::Known;
use crate::size::never_exact::NeverExact;
use serde::{Deserialize, Serialize};

/// What a record sees of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct Identified {
    /// The fitted individual \[declared units\], in the case's order.
    pub genes: Vec<f64>,
    /// Every unknown that was fitted.
    pub unknowns: Vec<UnknownEstimate>,
    /// Directions of the unknowns by how well they are seen, the best first.
    pub directions: Vec<Direction>,
    /// What the instruments are off by.
    pub nuisances: Vec<NeverExact>,
    /// What the answer predicts, condition by condition.
    pub bands: Vec<Band>,
    /// What further measurements would pin down, those that tell most first.
    pub further: Vec<Further>,
    /// Mean square of what the fit leaves, in units of the noise and per degree of freedom.
    pub left: f64,
    /// Whether that may be noise alone.
    pub is_noise: bool,
    /// How the noise is known.
    pub noise: Known,
    /// What else should be known.
    pub notes: Vec<String>,
}

/// An unknown with what the record says of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct UnknownEstimate {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// The likeliest value.
    pub value: f64,
    /// Where the profile rises by 3.84, below and above; none for an open end.
    pub interval: [Option<f64>; 2],
    /// How each side ends.
    pub ends: [End; 2],
    /// Which sides the record sees.
    pub seen: Seen,
    /// Unknowns that trade off with it: names with correlations.
    pub correlated: Vec<(String, f64)>,
    /// The profile: values with the rise of `-2 ln L`, all else refitted, by value.
    pub profile: Vec<[f64; 2]>,
}

/// Which ends of an unknown's interval a record gives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Seen {
    /// Both.
    Both,
    /// It is no smaller than that.
    LowerBound,
    /// It is no larger than that.
    UpperBound,
    /// Neither.
    NotSeen,
}

impl Seen {
    /// By which sides the profile rises on.
    pub const fn of(below: bool, above: bool) -> Self {
        match (below, above) {
            (true, true) => Self::Both,
            (true, false) => Self::LowerBound,
            (false, true) => Self::UpperBound,
            (false, false) => Self::NotSeen,
        }
    }
}

/// How a side of a profile ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum End {
    /// It rises by 3.84 there.
    Rises,
    /// It has not risen so far at the bound of the search.
    Bound,
    /// Simulations fail before it has: an end of the model, not of the record.
    Fails,
    /// It had not risen so far where it was given up.
    GivenUp,
}

/// A direction in which unknowns are seen independently of all others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Direction {
    /// Standard deviation along it: decades, or halves of the interval of what is searched on a linear
    /// scale; infinite where nothing is seen.
    pub sd_decades: f64,
    /// Unknowns with their parts of the unit vector, the largest first.
    pub parts: Vec<Part>,
    /// In words.
    pub words: String,
}

/// An unknown's part of a direction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Its name.
    pub name: String,
    /// Its component.
    pub part: f64,
}

/// What is predicted under a condition: 95 % bands of the simulated channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Index of the condition in the case.
    pub condition: usize,
    /// Its channels in their order.
    pub channels: Vec<Curve>,
}

/// A predicted curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// The likeliest.
    pub likeliest: Vec<f64>,
    /// Lower end of the band.
    pub low: Vec<f64>,
    /// Upper end.
    pub high: Vec<f64>,
}

impl Curve {
    /// Mean half width of the band, in the channel's unit.
    pub fn half_width(&self) -> f64 {
        let widths = self
            .low
            .iter()
            .zip(&self.high)
            .map(|(low, high)| high - low);
        0.5 * widths.sum::<f64>() / self.low.len().max(1) as f64
    }
}

/// A measurement that was not fitted, and what it would pin down.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Further {
    /// The measurement, in words.
    pub measurement: String,
    /// Unknowns whose standard deviation it would halve at least, the most first.
    pub pins: Vec<Pin>,
}

/// An unknown that a measurement would pin down.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Pin {
    /// Its name.
    pub name: String,
    /// Standard deviation now (decades, or halves of a linear interval).
    pub sd_now: f64,
    /// Standard deviation with the measurement beside the record.
    pub sd_then: f64,
}

/// Curves under a condition, and how they change per unit of every variable of a fit.
#[derive(Clone, Debug)]
pub(crate) struct Sight {
    pub(crate) condition: usize,
    /// At the fit, all channels of the condition.
    pub(crate) curves: Curves,
    /// By variable; none for one that is not known.
    pub(crate) changes: Vec<Option<Curves>>,
    /// The same channels at other points that the record does not refuse.
    pub(crate) others: Vec<Curves>,
}
