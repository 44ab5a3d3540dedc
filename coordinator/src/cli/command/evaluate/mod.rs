//! `horsehead evaluate`: scores the individuals of an external program on workers, one JSON line each.
mod messages;

use crate::cli::{
    argument::{
        case::{CaseChoice, LoadedCase},
        workers::WorkersChoice,
    },
    output::{problem::EXIT_CODES, terminal},
};
use case::require_record;
use clap::Args;
use messages::{Line, Tag};
use run::{
    manifest::{EVALUATE, Manifest, RunIdentity},
    name::RunName,
    opened::Run,
    session::Session,
};
use search::space::Space;
use serde::{Deserialize, Serialize};
use std::{
    io::{self, BufRead as _},
    path::PathBuf,
    sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    },
};
use study::{EvaluationRequest, evaluate};
use support::Problem;
use tokio::sync::mpsc;

/// Score individuals that another program asks for, on workers.
#[derive(Debug, Args)]
#[command(after_help = format!("\
One JSON object a line in, one out, in the order in which they are done:
  {{\"id\": 7, \"genes\": {{\"stiffness\": 7.8e8, ..}}}}          every unknown that the case searches
  {{\"id\": 7, \"objective\": 1.25, \"complete\": true, \"verdict\": \"complete\"}}
With \"residual\": true a complete one comes with \"residual\": [..], whose squared length is the
objective. A simulation that fails has a graded objective above every complete one's; what could
not be computed at all has null. A line that cannot be taken is answered by {{\"id\", \"line\",
\"error\", \"help\"}}, the others go on, and the program ends with exit code 2. Write many lines
before reading: they are done side by side. The end of the input ends it. What is asked again is
answered from the run's journal.

Example:
  horsehead evaluate cases/cyjs10-5-37hb --workers 2

{EXIT_CODES}"))]
pub(super) struct Arguments {
    #[command(flatten)]
    choice: CaseChoice,
    /// Run folder [default: runs/CASE-evaluate-seed0, with --measured also the folder's name and the start of
    /// its records' hash].
    #[arg(long, value_name = "DIR", env = "HORSEHEAD_RUN")]
    run: Option<PathBuf>,
    #[command(flatten)]
    workers: WorkersChoice,
}

/// Settings of an evaluate run: empty, since the case alone determines the scores.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Individuals {}

impl RunIdentity for Individuals {
    const KIND: &'static str = EVALUATE;
    const SEEDED: bool = false;
}

/// Maximum number of input lines that are read ahead and wait to be evaluated.
const WAITING: usize = 4096;

/// Scores the individuals read from standard input until the input ends.
pub(super) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let session = Session::begin();
    let run = begin(arguments)?;
    let space = Space::new(&run.case.unknowns)?;
    let options = arguments.workers.session()?;
    let (asking, mut requests) = mpsc::channel(WAITING);
    let refused = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&refused);
    // it blocks on the input, and is left behind when the work is over
    std::thread::spawn(move || read(&space, &asking, &counted));
    session.work(&run, &options, async |dispatch, stop| {
        let answer = &mut |tag: Tag, scored: &_| say(&Line::scored(&tag, scored));
        evaluate(dispatch, &run.case, &mut requests, answer, stop).await
    })?;
    match refused.load(Ordering::SeqCst) {
        0 => Ok(()),
        count => Err(Problem {
            message: format!("{count} input lines were rejected"),
            remedy:
                "each was answered with its error on standard output; all other lines were scored"
                    .to_owned(),
        }
        .into()),
    }
}

fn begin(arguments: &Arguments) -> anyhow::Result<Run<Individuals>> {
    let LoadedCase {
        case,
        measured,
        synthetic,
        notes,
        ..
    } = arguments.choice.load()?;
    require_record(&arguments.choice.case, &case, case.objective.condition)?;
    let path = if let Some(path) = &arguments.run {
        path.clone()
    } else {
        let name = RunName {
            case_folder: &arguments.choice.case,
            case: &case,
            what: EVALUATE,
            set: &[],
            measured: arguments.choice.measured.as_deref(),
            seed: 0,
        };
        name.path()?
    };
    let manifest = Manifest {
        measured,
        synthetic,
        notes,
        ..Manifest::new(&arguments.choice.case, 0, Individuals {})?
    };
    Run::begin(&path, manifest, case)
}

/// Reads input lines and sends the evaluation requests they contain, until the input ends or the receiver is
/// closed; answers each malformed line with an error.
fn read(space: &Space, asking: &mpsc::Sender<EvaluationRequest<Tag>>, refused: &AtomicUsize) {
    for (number, line) in (1..).zip(io::stdin().lock().lines()) {
        let Ok(line) = line else { return };
        if line.trim().is_empty() {
            continue;
        }
        match messages::read(&line, space) {
            Ok(request) => {
                if asking.blocking_send(request).is_err() {
                    return;
                }
            }
            Err(why) => {
                refused.fetch_add(1, Ordering::SeqCst);
                let _gone = say(&Line::Refused {
                    id: &why.id,
                    line: number,
                    error: &why.error,
                    help: &why.help,
                });
            }
        }
    }
}

fn say(line: &Line<'_>) -> anyhow::Result<()> {
    let mut text = serde_json::to_string(line)?;
    text.push('\n');
    terminal::write(&text)
}
