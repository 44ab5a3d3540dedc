//! Repetition of the fit of an answer that does not hold, has sizes that cannot be named, or needs instruments
//! that are far off, from other points: it may lie in a wrong minimum.
use crate::baseline::global_start::global_starts;
use crate::baseline::session::Session;
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use crate::model::unknowns::Point;
use search::least_squares::LeastSquaresSettings;

/// Points from which the fit of an answer is repeated.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Starts {
    /// Every size at which one of the answer's effects was tested, and the answer's effects with the unknowns of
    /// the case as they were before any fit. Optional work within the budget of the refits.
    Tested,
    /// The best points of a global search of the unknowns with the first of the answer's effects, with that
    /// effect alone and with all: in a wrong minimum further effects stand for what the first one explains in
    /// its own. The search without effects looked for the minimum of another model. It is done once, whatever
    /// is left of the budget: without it a found effect would be lost to the point where all were tested.
    Global,
}

impl Starts {
    /// All kinds of starts, the cheaper first.
    pub(crate) const ALL: [Self; 2] = [Self::Tested, Self::Global];
}

/// Returns the likeliest fit of the answer's effects, or of the first of them, from other points, if it is
/// likelier than the answer's own fit.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn fit_from_other_starts<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    rounds: &[WorkingRound],
    starts: Starts,
) -> Result<Option<Fit>, L::Error> {
    if answer.model.added.is_empty() {
        return Ok(None);
    }
    let inputs = session.inputs;
    let genes = inputs.space.dimension();
    // what instruments took up in another minimum keeps a fit from leaving it
    let exact = answer.point().with_exact_instruments();
    let points = match starts {
        Starts::Tested if !session.lab.has_budget(Stage::Refit) => Vec::new(),
        Starts::Tested => {
            let start = inputs.start.clone();
            let before = exact.with_genes(&start.unwrap_or_else(|| vec![0.0; genes]));
            let mut points = other_sizes(answer, rounds);
            points.push(before);
            points
        }
        Starts::Global => {
            let further = (1..answer.model.added.len()).rev();
            let first = further.fold(exact.clone(), Point::without);
            let mut experiments = session.experiments(Stage::Basin);
            let search = (inputs.global_search, inputs.seed);
            let rest = &first.x[genes..];
            let mut points = global_starts(&mut experiments, &first.model, rest, search).await?;
            if answer.model.added.len() > 1 {
                let all = |start: &Point| exact.clone().with_genes(&start.x[..genes]);
                let together: Vec<Point> = points.iter().map(all).collect();
                points.extend(together);
            }
            points
        }
    };
    if points.is_empty() {
        return Ok(None);
    }
    let mut experiments = session.experiments(Stage::Refit);
    let fits = experiments
        .fits(points, LeastSquaresSettings::short(8))
        .await?;
    let likelier = fits
        .into_iter()
        .flatten()
        .max_by(|a, b| a.log_evidence().total_cmp(&b.log_evidence()));
    Ok(likelier.filter(|fit| fit.log_evidence() > answer.log_evidence()))
}

/// Returns the answer at each other size at which one of its effects was tested; effects that act in proportion
/// to their size have none.
fn other_sizes(answer: &Fit, rounds: &[WorkingRound]) -> Vec<Point> {
    let mut points = Vec::new();
    for (position, effect) in answer.model.added.iter().enumerate() {
        let mut tested = rounds.iter().flat_map(|round| &round.candidates);
        let Some(own) = tested.find(|own| own.effect.id == effect.id) else {
            continue;
        };
        let without = answer.point().without(position);
        let from = own.rungs.iter();
        points.extend(from.map(|start| without.clone().with(effect, start)));
    }
    points
}
