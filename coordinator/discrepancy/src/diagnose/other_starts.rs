//! Repetition of the fit of an answer that does not predict, from other sizes of its effects: a fit in a wrong
//! minimum explains the fitted record only.
use crate::baseline::session::Session;
use crate::hypothesis::round::Round;
use crate::laboratory::{Laboratory, Stage};
use crate::model::fit::Fit;
use search::least_squares::LeastSquaresSettings;

/// Returns the likeliest fit of the answer's effects from every size at which one of them was tested, if it is
/// likelier than the answer's own fit; effects that act in proportion to their size have no other start.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn fit_from_other_starts<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    rounds: &[Round],
) -> Result<Option<Fit>, L::Error> {
    let mut starts = Vec::new();
    for (position, effect) in answer.model.added.iter().enumerate() {
        let mut tested = rounds.iter().flat_map(|round| &round.candidates);
        let Some(own) = tested.find(|own| own.effect.id == effect.id) else {
            continue;
        };
        let without = answer.point().without(position);
        let from = own.rungs.iter();
        starts.extend(from.map(|start| without.clone().with(effect, start)));
    }
    if starts.is_empty() || !session.lab.has_budget(Stage::Refit) {
        return Ok(None);
    }
    let mut experiments = session.experiments(Stage::Refit);
    let fits = experiments
        .fits(starts, LeastSquaresSettings::short(8))
        .await?;
    let likelier = fits
        .into_iter()
        .flatten()
        .max_by(|a, b| a.log_evidence().total_cmp(&b.log_evidence()));
    Ok(likelier.filter(|fit| fit.log_evidence() > answer.log_evidence()))
}
