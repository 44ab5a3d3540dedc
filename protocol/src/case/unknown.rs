//! The unknown numbers of a case: what a search moves, and what is known of each before it starts.
//!
//! Steps of a search are in *coordinates*, 0 at the start: decades on a logarithmic scale, halves of the
//! interval on a linear one. Nothing here knows what an unknown means to the model that it belongs to.
use serde::{Deserialize, Serialize};

/// How equal steps of a search change a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scale {
    /// By equal factors: what is positive and known to an order of magnitude.
    Logarithmic,
    /// By equal amounts: what may be zero or negative.
    Linear,
}

/// One unknown number with the interval to search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Its name in files and tables. That of an effect's parameter is `effect.parameter`.
    pub name: String,
    /// What it is, in words.
    pub title: String,
    /// Its symbol, an index behind `_`; the name where it has none.
    pub symbol: String,
    /// Unit of its values, a word.
    pub unit: String,
    /// How equal steps change it.
    pub scale: Scale,
    /// Where a search starts: its recommended value.
    pub start: f64,
    /// Smallest value to search.
    pub lower: f64,
    /// Largest value to search.
    pub upper: f64,
    /// From where to where models usually survive (coordinates); the whole interval where nobody knows.
    pub trust: Option<[f64; 2]>,
    /// Its valley, if that is too narrow to be met by chance.
    pub valley: Option<Valley>,
    /// What is known of it beside its bounds.
    pub prior: Option<Prior>,
    /// The value at which it does nothing, if there is one. Where it starts there it is off: held, and
    /// not searched.
    pub absent: Option<f64>,
    /// Whether it is held at its start.
    pub fixed: bool,
    /// The unknown that it follows, if it follows one.
    pub tie: Option<Tie>,
    /// What differences move it by (coordinate), where its model says what suits it.
    pub step: Option<f64>,
    /// Name of what is suspected together with it where it is off: unknowns of one suspect act together.
    pub suspect: Option<String>,
}

/// How the valley of an unknown is found: by scanning it on a grid, along several lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Valley {
    /// Where the grid begins (coordinate).
    pub from: f64,
    /// Where it ends (coordinate).
    pub to: f64,
    /// Its spacing, about the width of the valley (coordinate).
    pub step: f64,
    /// Other unknowns that can hide the valley, each with the shift that uncovers it. A search scans
    /// with every set of them.
    pub uncovered_by: Vec<Shift>,
    /// The unknown that must lie near a share of the scanned one for the valley to show. A diagnosis
    /// scans with every share.
    pub shares: Option<Shares>,
    /// What else can stand in for the scanned one: further sets of lines of a diagnosis, one per shift.
    pub stand_ins: Vec<Shift>,
}

/// An unknown moved for a whole line of a scan.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shift {
    /// Its name.
    pub unknown: String,
    /// By how much (coordinate).
    pub by: f64,
}

/// An unknown held at shares of another.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Shares {
    /// Its name.
    pub unknown: String,
    /// Its value over that of the scanned one, one per set of lines [its unit over that of the scanned].
    pub of_scanned: Vec<f64>,
}

/// What is known of an unknown before anything is measured: a value, and how far from it the truth is
/// rarely found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prior {
    /// The likeliest value [the unknown's unit].
    pub value: f64,
    /// One standard deviation (coordinate).
    pub deviation: f64,
}

/// Always this ratio of another unknown.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Tie {
    /// Name of the other one.
    pub to: String,
    /// Its value over that of the other [its unit over that of the other].
    pub ratio: f64,
}

impl Unknown {
    /// One that is searched, and of which no more is known.
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

    /// Whether it starts where it does nothing: then it is held there.
    pub fn is_off(&self) -> bool {
        self.absent == Some(self.start)
    }

    /// Effect and parameter, if it is a parameter of one of the case's effects.
    pub fn of_effect(&self) -> Option<(&str, &str)> {
        self.name.split_once('.')
    }
}
