//! What is said, as JSON: the first line, answers, and what is said back. It knows no search.
use search::strategy::Proposal;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;
use std::collections::BTreeMap;
use support::Problem;

/// The first line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Opening {
    /// What is searched.
    pub(super) space: Vec<Axis>,
    /// Fixes every random choice.
    #[serde(default = "one")]
    pub(super) seed: u64,
    /// Most evaluations.
    pub(super) budget: Option<u64>,
    /// Points to evaluate first and to begin the search with.
    #[serde(default)]
    pub(super) start: Vec<Vec<f64>>,
    /// Settings by name.
    #[serde(default)]
    pub(super) settings: BTreeMap<String, Value>,
}

const fn one() -> u64 {
    1
}

/// One unknown.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Axis {
    pub(super) name: String,
    pub(super) lower: f64,
    pub(super) upper: f64,
    #[serde(default)]
    pub(super) scale: Scale,
    /// The middle where none is given.
    pub(super) start: Option<f64>,
}

/// How equal steps change an unknown.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Scale {
    #[default]
    Linear,
    Log,
}

/// Every later line.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Answers {
    pub(super) tell: Vec<Answer>,
}

/// What came of a point.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Answer {
    pub(super) id: u64,
    /// What is minimised; the squared length of the residual where that alone is told.
    pub(super) f: Option<f64>,
    /// Whether there is no such number.
    #[serde(default)]
    pub(super) failed: bool,
    /// In units in which its squared length is `f`.
    #[serde(default)]
    pub(super) residual: Vec<f64>,
}

/// A line out.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Line {
    /// Points to evaluate.
    Ask { ask: Vec<Point> },
    /// The end.
    Done {
        done: &'static str,
        evaluations: u64,
        best: Best,
    },
    /// A line could not be taken.
    Error {
        error: String,
        help: String,
        evaluations: u64,
        best: Option<Best>,
    },
}

/// A point to evaluate.
#[derive(Debug, Serialize)]
pub(super) struct Point {
    id: u64,
    x: Vec<f64>,
    /// Whether the residual is of use beside the number.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    residual: bool,
}

impl From<Proposal> for Point {
    fn from(proposal: Proposal) -> Self {
        Self {
            id: proposal.id,
            x: proposal.genes,
            residual: proposal.purpose.wants_residual(),
        }
    }
}

/// The best point.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Best {
    pub(super) id: u64,
    pub(super) x: Vec<f64>,
    pub(super) f: f64,
}

/// Nothing was said.
pub(super) fn silent() -> Problem {
    let help = "begin with one line that has `space`; `horsehead ask-tell --help` shows one";
    Problem::new("the input ended before its first line", help)
}

/// With the line, counted from 1.
pub(super) fn at(problem: Problem, number: usize) -> Problem {
    let message = format!("line {number}: {}", problem.message);
    Problem { message, ..problem }
}

/// Reads a line.
pub(super) fn read<T: DeserializeOwned>(line: &str, example: &str) -> Result<T, Problem> {
    serde_json::from_str(line).map_err(|error| {
        let mut help = format!("a line is one object, as {example}");
        if ["NaN", "Infinity"].iter().any(|word| line.contains(word)) {
            help += "; JSON has finite numbers only: say {\"id\": .., \"failed\": true}";
        }
        Problem::new(format!("it cannot be read: {error}"), help)
    })
}
