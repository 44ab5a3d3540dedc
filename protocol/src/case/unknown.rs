//! Unknowns of a case: the numbers that a search varies, with the knowledge about each before the search.
//!
//! Steps of a search are measured in *coordinates*, 0 at the start: decades on a logarithmic scale, halves of
//! the interval on a linear one. This module is independent of the meaning of an unknown in its model.
use serde::{Deserialize, Serialize};

/// Scale of an unknown: effect of equal search steps on its value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// Equal steps multiply by equal factors; for positive values known to an order of magnitude.
    Logarithmic,
    /// Equal steps add equal amounts; for values that may be zero or negative.
    Linear,
}

/// Unknown with its search interval.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Name in files and tables; `effect.parameter` for a parameter of an effect.
    pub name: String,
    /// Description in words.
    pub title: String,
    /// Symbol, with an index after `_`; the name if the unknown has no symbol.
    pub symbol: String,
    /// Unit of the values, as text.
    pub unit: String,
    /// Scale on which the unknown is searched.
    pub scale: Scale,
    /// Start value of a search: the recommended value.
    pub start: f64,
    /// Lower bound of the search.
    pub lower: f64,
    /// Upper bound of the search.
    pub upper: f64,
    /// Interval in which simulations usually succeed (coordinates); `None` for the whole search interval.
    pub trust: Option<[f64; 2]>,
    /// Valley of the objective along this unknown, if it is too narrow to be found by random sampling.
    pub valley: Option<Valley>,
    /// Prior knowledge of the value in addition to the bounds.
    pub prior: Option<Prior>,
    /// Value at which the unknown has no effect, if there is one. An unknown that starts at this value is
    /// switched off: held there and not searched.
    pub absent: Option<f64>,
    /// Whether the unknown is held at its start.
    pub fixed: bool,
    /// Tie to another unknown, if this one follows another.
    pub tie: Option<Tie>,
    /// Finite-difference step (coordinate), if the model states a suitable one.
    pub step: Option<f64>,
    /// Name of the suspected cause to which the unknown belongs while it is switched off; unknowns with the
    /// same name are switched on together.
    pub suspect: Option<String>,
}

/// Scan for the valley of an unknown: a grid of values along several lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Valley {
    /// First grid value (coordinate).
    pub from: f64,
    /// Last grid value (coordinate).
    pub to: f64,
    /// Grid spacing, about the width of the valley (coordinate).
    pub step: f64,
    /// Other unknowns that can hide the valley, each with the shift that reveals it. A search scans with
    /// every subset of these shifts.
    pub uncovered_by: Vec<Shift>,
    /// Unknown that must lie near a fraction of the scanned one for the valley to show. A diagnosis scans
    /// with every fraction.
    pub shares: Option<Shares>,
    /// Shifts of other unknowns that can compensate for a wrong value of the scanned one; a diagnosis scans
    /// an additional set of lines for each.
    pub stand_ins: Vec<Shift>,
}

/// Displacement of an unknown along a whole line of a scan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Name of the displaced unknown.
    pub unknown: String,
    /// Displacement (coordinate).
    pub by: f64,
}

/// Unknown held at fractions of the scanned unknown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// Name of the held unknown.
    pub unknown: String,
    /// Ratios of the held unknown's value to the scanned one's, one per set of lines [held unit / scanned
    /// unit].
    pub of_scanned: Vec<f64>,
}

/// Prior of an unknown, i.e. its knowledge before any measurement: most likely value and standard deviation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prior {
    /// Most likely value [the unknown's unit].
    pub value: f64,
    /// Standard deviation (coordinate).
    pub deviation: f64,
}

/// Fixed ratio of an unknown to another unknown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tie {
    /// Name of the other unknown.
    pub to: String,
    /// Value of the tied unknown divided by that of the other [tied unit / other unit].
    pub ratio: f64,
}

impl Unknown {
    /// Creates an unknown that is searched, without optional information.
    pub fn new(
        name: impl Into<String>,
        unit: impl Into<String>,
        scale: Scale,
        start: f64,
        [lower, upper]: [f64; 2],
    ) -> Self {
        let name = name.into();
        Self {
            title: name.clone(),
            symbol: name.clone(),
            name,
            unit: unit.into(),
            scale,
            start,
            lower,
            upper,
            trust: None,
            valley: None,
            prior: None,
            absent: None,
            fixed: false,
            tie: None,
            step: None,
            suspect: None,
        }
    }

    /// Returns whether the unknown is switched off, i.e. starts at its absent value and is held there.
    pub fn is_off(&self) -> bool {
        self.absent == Some(self.start)
    }

    /// Returns the names of effect and parameter if the unknown is a parameter of an effect.
    pub fn of_effect(&self) -> Option<(&str, &str)> {
        self.name.split_once('.')
    }
}
