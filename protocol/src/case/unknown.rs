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

/// Unknown of a case: a number that a search varies, with its bounds and prior knowledge.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Name in files and tables; `effect.parameter` for a parameter of an effect.
    pub name: String,
    /// Description of the unknown in words.
    pub title: String,
    /// Symbol of the unknown for display, with an index after `_`; the name if it has no symbol.
    pub symbol: String,
    /// Unit of the unknown's values, as text.
    pub unit: String,
    /// Scale on which the unknown is searched.
    pub scale: Scale,
    /// Value of the unknown at which a search starts: the recommended value.
    pub start: f64,
    /// Lower bound of the unknown in a search.
    pub lower: f64,
    /// Upper bound of the unknown in a search.
    pub upper: f64,
    /// Interval in which simulations usually succeed (coordinates); `None` for the whole search interval.
    pub trust: Option<[f64; 2]>,
    /// Scan for a minimum of the objective along this unknown that is too narrow to be found by random
    /// sampling; `None` if there is none.
    pub valley: Option<Valley>,
    /// Prior knowledge of the value in addition to the bounds.
    pub prior: Option<Prior>,
    /// Value at which the unknown has no effect, if there is one. An unknown that starts at this value is
    /// switched off: held there and not searched.
    pub absent: Option<f64>,
    /// Whether the unknown is held at its start.
    pub fixed: bool,
    /// Fixed ratio to another unknown that this one follows; `None` for an independent unknown.
    pub tie: Option<Tie>,
    /// Finite-difference step (coordinate), if the model states a suitable one.
    pub step: Option<f64>,
    /// Name of the suspected cause to which the unknown belongs while it is switched off; unknowns with the
    /// same name are switched on together.
    pub suspect: Option<String>,
    /// Whether the unknown is a parameter of an effect; its name is then `EFFECT.PARAMETER`.
    pub is_effect: bool,
}

/// Scan for a narrow minimum ("valley") of the objective along an unknown: a grid of values along several
/// lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Valley {
    /// First grid value of the scan (search coordinate).
    pub from: f64,
    /// Last grid value of the scan (search coordinate).
    pub to: f64,
    /// Grid spacing of the scan, about the width of the narrow minimum (search coordinates).
    pub step: f64,
    /// Shifts of other unknowns that reveal the narrow minimum where they would hide it. A search scans with
    /// every subset of these shifts.
    pub uncovered_by: Vec<Shift>,
    /// Other unknown that must be near a fraction of the scanned one for the narrow minimum to appear. A
    /// diagnosis scans with every listed fraction.
    pub shares: Option<HeldRatios>,
    /// Shifts of other unknowns that can compensate for a wrong value of the scanned one; a diagnosis scans
    /// additional lines for each.
    pub stand_ins: Vec<Shift>,
}

/// Displacement of another unknown from its value while a line of the scan is evaluated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Name of the displaced unknown.
    pub unknown: String,
    /// Displacement of the unknown (search coordinates).
    pub by: f64,
}

/// Other unknown that a scan holds at fractions of the scanned unknown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HeldRatios {
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
    /// Standard deviation of the prior (search coordinates).
    pub deviation: f64,
}

/// Fixed ratio of an unknown to another unknown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tie {
    /// Name of the unknown that the tied one follows.
    pub to: String,
    /// Ratio of the tied unknown's value to that of the unknown it follows [tied unit / other unit].
    pub ratio: f64,
}

impl Unknown {
    /// Creates an unknown that is searched within its bounds, without optional information.
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
            is_effect: false,
        }
    }

    /// Returns whether the unknown is switched off, i.e. starts at its absent value and is held there.
    pub fn is_off(&self) -> bool {
        self.absent == Some(self.start)
    }

    /// Returns the names of effect and parameter if the unknown is a parameter of an effect.
    pub fn of_effect(&self) -> Option<(&str, &str)> {
        let parts = self.name.split_once('.');
        parts.filter(|_| self.is_effect)
    }
}
