//! `horsehead ask-tell`: lets an external program drive a search strategy over standard input and output.
mod messages;
mod session;

use crate::cli::output::{problem::EXIT_CODES, terminal};
use clap::{Args, builder::PossibleValuesParser};
use messages::Line;
use search::strategy::CATALOGUE;
use session::{Dialogue, Opening};
use std::io::{self, BufRead as _};
use support::Problem;

/// Let another program evaluate what a strategy asks for.
#[derive(Debug, Args)]
#[command(after_help = format!("\
One JSON object a line in, one out. First in:
  {{\"space\": [{{\"name\": \"k\", \"lower\": 1e3, \"upper\": 1e9, \"scale\": \"log\"}},
             {{\"name\": \"x0\", \"lower\": -1, \"upper\": 1, \"scale\": \"linear\", \"start\": 0.2}}],
   \"seed\": 1, \"budget\": 500, \"settings\": {{\"population\": 20}}}}   (on one line)
The start is the middle, the seed 1, the budget what the strategy plans and the settings those
of the preset where they are left out; `horsehead calibrate --help` lists settings. \"start\":
[[1e5, 0.1], ..] are points to evaluate before the search, on top of what it plans, and to begin
it with. Then out:
  {{\"ask\": [{{\"id\": 0, \"x\": [1e6, 0.2]}}]}}
and in, in any order, one point or many to a line:
  {{\"tell\": [{{\"id\": 0, \"f\": 3.5}}, {{\"id\": 1, \"failed\": true}}]}}
The smaller f is the better. A point with \"residual\": true may be told with \"residual\": [..]
alone, for f is its squared length; quick, least-squares, descent and hybrid go nowhere without,
memetic needs f alone. Every line is answered, by {{\"ask\": []}} while points are open. Last out:
  {{\"done\": \"planned\", \"evaluations\": 500, \"best\": {{\"id\": 7, \"x\": [..], \"f\": 0.1}}}}
done: planned, threshold, budget, or input, as its end is the end. A line that cannot be taken
ends the talk, too: {{\"error\": .., \"help\": .., \"evaluations\": .., \"best\": ..}}, and nothing of it
was taken.

Example:
  horsehead ask-tell memetic

{EXIT_CODES}"))]
pub(super) struct Arguments {
    /// The strategy: a preset of `horsehead calibrate`.
    #[arg(value_parser = PossibleValuesParser::new(CATALOGUE.iter().map(|preset| preset.name)))]
    strategy: String,
}

/// Runs the ask-tell dialogue until the strategy finishes, the input ends, or a line is rejected.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let mut talk: Option<Dialogue> = None;
    for (number, line) in (1..).zip(io::stdin().lock().lines()) {
        let line = line?;
        if line.trim().is_empty() {
            continue;
        }
        let said = match &mut talk {
            Some(talk) => talk.take(&line),
            None => Opening::read(&line)
                .and_then(|opening| opening.begin(&arguments.strategy))
                .map(|begun| talk.insert(begun).ask()),
        };
        match said {
            Ok(said) => {
                say(&said)?;
                if matches!(said, Line::Done { .. }) {
                    return Ok(());
                }
            }
            Err(refused) => return end(talk.as_ref(), messages::with_line_number(refused, number)),
        }
    }
    match talk.as_ref().map(Dialogue::close) {
        Some(Ok(said)) => say(&said),
        Some(Err(refused)) => end(talk.as_ref(), refused),
        None => end(None, messages::empty_input()),
    }
}

fn say(line: &Line) -> anyhow::Result<()> {
    let mut text = serde_json::to_string(line)?;
    text.push('\n');
    terminal::write(&text)
}

/// Writes the last line of a dialogue that ends with an error: the error, and the best point found so far.
fn end(talk: Option<&Dialogue>, problem: Problem) -> anyhow::Result<()> {
    let (evaluations, best) = talk.map_or((0, None), Dialogue::summary);
    say(&Line::Error {
        error: problem.message.clone(),
        help: problem.remedy.clone(),
        evaluations,
        best,
    })?;
    Err(problem.into())
}
