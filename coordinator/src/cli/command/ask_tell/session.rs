//! State of the dialogue with an external evaluator: passes the reported values to the search strategy and
//! returns the next points to evaluate. Independent of where the lines come from.
use super::messages::{Answer, Answers, Axis, Best, Line, Point, Scale, read};
use protocol::case::{self, Unknown};
use run::settings;
use search::{
    space::Space,
    strategy::{EvaluationResult, Finish, Residual, SearchPlan, Strategy, build_after, preset},
};
use std::collections::BTreeMap;
use support::Problem;

pub(super) use super::messages::Opening;

/// State of a running ask-tell dialogue.
pub(super) struct Dialogue {
    strategy: Box<dyn Strategy>,
    left: u64,
    proposed: u64,
    open: BTreeMap<u64, Vec<f64>>,
    reported: u64,
    /// Best point reported so far, even if the strategy has not processed its result yet.
    best: Option<Best>,
}

impl Axis {
    fn unknown(self) -> Unknown {
        let (scale, middle) = match self.scale {
            Scale::Linear => (case::Scale::Linear, 0.5 * (self.lower + self.upper)),
            Scale::Log => {
                let middle = libm::sqrt(self.lower) * libm::sqrt(self.upper);
                (case::Scale::Logarithmic, middle)
            }
        };
        let start = self.start.unwrap_or(middle);
        Unknown::new(self.name, "1", scale, start, [self.lower, self.upper])
    }
}

/// Checks that every starting point of the opening line has one value per axis, inside the bounds, and
/// returns the points.
fn first_points(space: &Space, points: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, Problem> {
    for (number, point) in (1..).zip(points) {
        let axes = space.axes();
        let refuse = |why: String| {
            let help =
                "give each point of `start` one number per axis of `space`, inside its bounds";
            Err(Problem::new(format!("start: point {number} {why}"), help))
        };
        if point.len() != axes.len() {
            return refuse(format!(
                "has {} numbers, the space {}",
                point.len(),
                axes.len()
            ));
        }
        for (axis, value) in axes.iter().zip(point) {
            let unknown = &axis.unknown;
            if !(unknown.lower..=unknown.upper).contains(value) {
                let bounds = format!("outside {:e} to {:e}", unknown.lower, unknown.upper);
                return refuse(format!("has {} = {value:e}, {bounds}", unknown.name));
            }
        }
    }
    Ok(points.to_vec())
}

impl Opening {
    /// Parses the opening line of the dialogue, which defines the search.
    pub(super) fn read(line: &str) -> Result<Self, Problem> {
        let example = "{\"space\": [{\"name\": \"x\", \"lower\": -1, \"upper\": 1}]}";
        read(line, example)
    }

    /// Builds the search space and the strategy that the opening line defines, and returns the dialogue.
    pub(super) fn begin(self, strategy: &str) -> Result<Dialogue, Problem> {
        let unknowns: Vec<Unknown> = self.space.into_iter().map(Axis::unknown).collect();
        let bounds = "give each a name of its own, finite lower < upper with the start between, above \
                      0 on a log scale";
        let space = Space::new(&unknowns);
        let space = space.map_err(|error| Problem::new(format!("space: {error}"), bounds))?;
        let preset = preset(strategy).ok_or_else(|| {
            Problem::new(format!("there is no strategy `{strategy}`"), "see --help")
        })?;
        let set = self.settings.into_iter().map(|(key, value)| {
            let words = value.as_str().map(str::to_owned);
            (key, words.unwrap_or_else(|| value.to_string()))
        });
        let set: Vec<_> = set.collect();
        let plan = SearchPlan {
            space: &space,
            workers: 1,
        };
        let chosen = settings::choose(&set, preset, &plan);
        let chosen = chosen?;
        let first = first_points(&space, &self.start)?;
        let strategy = build_after(&chosen.settings, &space, self.seed, &first);
        let strategy = strategy.map_err(|error| {
            Problem::new(
                format!("settings: {error}"),
                "`horsehead calibrate --help` lists what every setting may be",
            )
        })?;
        let left = self.budget.unwrap_or(u64::MAX);
        if left == 0 {
            return Err(Problem::new(
                "budget is 0",
                "give at least 1, or leave it out",
            ));
        }
        Ok(Dialogue {
            strategy,
            left,
            proposed: 0,
            open: BTreeMap::new(),
            reported: 0,
            best: None,
        })
    }
}

impl Dialogue {
    /// Asks the strategy for points to evaluate now, within the remaining budget.
    pub(super) fn ask(&mut self) -> Line {
        let mut asked = self.strategy.ask();
        asked.truncate(usize::try_from(self.left).unwrap_or(usize::MAX));
        self.left -= asked.len() as u64;
        self.proposed += asked.len() as u64;
        let open = asked.iter();
        self.open
            .extend(open.map(|proposal| (proposal.id, proposal.genes.clone())));
        let ask = asked.into_iter().map(Point::from).collect();
        Line::Ask { ask }
    }

    /// Processes a line of answers and returns the line to reply with; if one answer is invalid, none is
    /// processed.
    pub(super) fn take(&mut self, line: &str) -> Result<Line, Problem> {
        let answers: Answers = read(line, "{\"tell\": [{\"id\": 0, \"f\": 3.5}]}")?;
        let mut told = BTreeMap::new();
        for answer in answers.tell {
            let id = answer.id;
            if !self.open.contains_key(&id) {
                return Err(self.unknown_id(id));
            }
            if told.insert(id, answer.into_told()?).is_some() {
                return Err(Problem::new(
                    format!("point {id} is told twice in the same line"),
                    "tell every point once",
                ));
            }
        }
        for (id, (result, residual)) in told {
            self.reported += 1;
            let f = result.fitness;
            // of equals the first that was asked for, whatever the order in which they are told
            let better = |best: &Best| f < best.f || (f <= best.f && id < best.id);
            let better = self.best.as_ref().is_none_or(better);
            if let Some(x) = self.open.remove(&id).filter(|_| result.complete && better) {
                self.best = Some(Best { id, x, f });
            }
            if let Some(residual) = residual {
                self.strategy.tell_residual(id, residual);
            }
            self.strategy.tell(id, result);
        }
        let done = match self.strategy.finished() {
            Some(Finish::Planned) => "planned",
            Some(Finish::Threshold) => "threshold",
            None => {
                let asked = self.ask();
                if !self.open.is_empty() {
                    return Ok(asked);
                }
                "budget"
            }
        };
        self.end(done)
    }

    /// Ends the dialogue because the input ended, and returns the last line to write.
    pub(super) fn close(&self) -> Result<Line, Problem> {
        self.end("input")
    }

    /// Returns the number of points whose value has been reported, and the best of them.
    pub(super) fn summary(&self) -> (u64, Option<Best>) {
        (self.reported, self.best.clone())
    }

    fn end(&self, done: &'static str) -> Result<Line, Problem> {
        let (evaluations, best) = self.summary();
        let failed = || match evaluations {
            0 => Problem::new(
                "the input ended, and no point was told",
                "answer each proposed point with {\"tell\": [{\"id\": .., \"f\": ..}]}",
            ),
            _ => Problem::new(
                format!("all of the {evaluations} points failed"),
                "check the evaluation at the start, and the bounds",
            ),
        };
        let best = best.ok_or_else(failed)?;
        Ok(Line::Done {
            done,
            evaluations,
            best,
        })
    }

    /// Explains why the id of an answer belongs to no point that awaits a value.
    fn unknown_id(&self, id: u64) -> Problem {
        let open: Vec<String> = self.open.keys().take(9).map(u64::to_string).collect();
        let help = format!("open are {}", open.join(", "));
        let why = if id < self.proposed {
            "has been told before"
        } else {
            "was not asked for"
        };
        Problem::new(format!("point {id} {why}"), help)
    }
}

impl Answer {
    fn into_told(self) -> Result<(EvaluationResult, Option<Residual>), Problem> {
        let id = self.id;
        let refuse = |why: &str| {
            let help =
                "say \"f\" with a number, \"residual\" with its numbers, or \"failed\": true";
            Err(Problem::new(format!("point {id} {why}"), help))
        };
        let squared = |residual: &[f64]| residual.iter().map(|r| r * r).sum();
        let told = !self.residual.is_empty() && !self.failed;
        let f = self.f.or_else(|| told.then(|| squared(&self.residual)));
        match (f, self.failed) {
            (Some(fitness), false) => {
                let by = BTreeMap::new();
                let residual = (!self.residual.is_empty()).then_some(Residual {
                    values: self.residual,
                    derivatives: by,
                });
                let complete = true;
                Ok((EvaluationResult { fitness, complete }, residual))
            }
            (None, true) => Ok((
                EvaluationResult {
                    fitness: f64::INFINITY,
                    complete: false,
                },
                None,
            )),
            (Some(_), true) => refuse("has a number and failed"),
            (None, false) => refuse("has no number"),
        }
    }
}
