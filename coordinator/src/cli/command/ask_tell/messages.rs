//! JSON messages of the ask-tell dialogue: opening line, answers and replies. Independent of the search.
use search::strategy::Proposal;
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use serde_json::Value;
use std::collections::BTreeMap;
use support::Problem;

/// Opening line of the ask-tell dialogue: defines the search.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Opening {
    /// Axes of the search space, one per unknown.
    pub(super) space: Vec<Axis>,
    #[serde(default = "one")]
    pub(super) seed: u64,
    /// Maximum number of evaluations of the search; if absent, the number that the strategy plans.
    pub(super) budget: Option<u64>,
    /// Starting points, which the search evaluates first.
    #[serde(default)]
    pub(super) start: Vec<Vec<f64>>,
    /// Settings of the search that replace those of the preset, by name.
    #[serde(default)]
    pub(super) settings: BTreeMap<String, Value>,
}

const fn one() -> u64 {
    1
}

/// One unknown of the search space: name, bounds, scale and starting value.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Axis {
    pub(super) name: String,
    pub(super) lower: f64,
    pub(super) upper: f64,
    #[serde(default)]
    pub(super) scale: Scale,
    /// Starting value of the unknown; the middle of its range if absent.
    pub(super) start: Option<f64>,
}

/// Scale of an unknown on which equal search steps are taken.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Scale {
    #[default]
    Linear,
    Log,
}

/// Input line after the opening line, with the results of proposed points.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Answers {
    pub(super) tell: Vec<Answer>,
}

/// Result reported for one proposed point.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Answer {
    pub(super) id: u64,
    /// Objective value of the point; if absent, the squared length of `residual`.
    pub(super) f: Option<f64>,
    /// Whether the evaluation of the point failed, so that there is no objective value.
    #[serde(default)]
    pub(super) failed: bool,
    /// Residual vector of the point, scaled so that its squared length is `f`; empty if not reported.
    #[serde(default)]
    pub(super) residual: Vec<f64>,
}

/// Line of the ask-tell dialogue that is written to standard output.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(super) enum Line {
    /// Request to evaluate points.
    Ask { ask: Vec<Point> },
    /// Last line of a search that ended normally.
    Done {
        done: &'static str,
        evaluations: u64,
        best: Best,
    },
    /// Last line of a dialogue that ended because an input line was rejected.
    Error {
        error: String,
        help: String,
        evaluations: u64,
        best: Option<Best>,
    },
}

/// Proposed point, which the external program is to evaluate.
#[derive(Debug, Serialize)]
pub(super) struct Point {
    id: u64,
    x: Vec<f64>,
    /// Whether the strategy can use the residual vector of this point besides its objective value.
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

/// Best point that the external program has reported so far.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Best {
    pub(super) id: u64,
    pub(super) x: Vec<f64>,
    pub(super) f: f64,
}

/// Returns the error for input that ended before its first line.
pub(super) fn empty_input() -> Problem {
    let help = "begin with one line that has `space`; `horsehead ask-tell --help` shows one";
    Problem::new("the input ended before its first line", help)
}

/// Prefixes an error about an input line with its line number, counted from 1.
pub(super) fn with_line_number(problem: Problem, number: usize) -> Problem {
    let message = format!("line {number}: {}", problem.message);
    Problem { message, ..problem }
}

/// Parses an input line of the dialogue; if that fails, the error's remedy shows the valid line `example`.
pub(super) fn read<T: DeserializeOwned>(line: &str, example: &str) -> Result<T, Problem> {
    serde_json::from_str(line).map_err(|error| {
        let mut help = format!("a line is one object, as {example}");
        if ["NaN", "Infinity"].iter().any(|word| line.contains(word)) {
            help += "; JSON has finite numbers only: say {\"id\": .., \"failed\": true}";
        }
        Problem::new(format!("the line cannot be read: {error}"), help)
    })
}
