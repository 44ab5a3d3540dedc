//! Joint tests of several effects.
//!
//! Where two or three effects act, each alone may explain less than a different effect that resembles their
//! sum. All pairs and triples are evaluated on the projected linear system; the best are refitted with every
//! unknown free, and the refits decide.
use crate::hypothesis::candidate::WorkingCandidate;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::subset::{Subset, Subsets};
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{positive, sized};
use crate::model::unknowns::Point;
use search::least_squares::LeastSquaresSettings;

/// Passes of the search for effect combinations: number of effects per combination, and number of
/// combinations that are refitted as far as the budget allows.
const TRIED: [(usize, usize); 3] = [(2, 3), (3, 1), (2, 9)];
/// Number of effect combinations that are refitted in parallel.
const AT_ONCE: usize = 4;

/// Effects that were refitted jointly.
#[derive(Clone, Debug)]
pub(crate) struct JointRefit {
    /// Identifiers of the effects, in descending order of their individual statistic.
    pub(crate) members: Vec<String>,
    /// Joint fit of the effects, which are the last ones of its model.
    pub(crate) fit: Fit,
}

/// Refits the best pairs and triples of candidate effects, with at most `most` effects each; subsets that
/// cannot be simulated are omitted.
pub(crate) async fn joint_refits<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    suspects: &[WorkingCandidate],
    most: usize,
) -> Result<Vec<JointRefit>, L::Error> {
    let able = suspects.iter().filter(|s| s.signature.ncols() > 0);
    let able: Vec<&WorkingCandidate> = able.collect();
    let signatures = able
        .iter()
        .map(|own| (&own.signature, positive(&own.effect)));
    let residual = fit.search.linear_minimum_residual();
    let subsets = Subsets::new(&residual, &signatures.collect::<Vec<_>>(), &fit.tangent());
    let tried = TRIED.into_iter().filter(|(count, _)| *count <= most);
    let mut proposals: Vec<Subset> = Vec::new();
    for subset in tried.flat_map(|(count, kept)| subsets.best(count, kept)) {
        if proposals
            .iter()
            .all(|other| other.members != subset.members)
        {
            proposals.push(subset);
        }
    }
    let mut fits = Vec::new();
    for some in proposals.chunks(AT_ONCE) {
        if !fits.is_empty() && !experiments.lab.has_budget(Stage::Refit) {
            break;
        }
        let starts = some.iter().map(|own| started(fit, &able, own));
        fits.extend(
            experiments
                .fits(starts.collect(), LeastSquaresSettings::short(6))
                .await?,
        );
    }
    let members = |subset: &Subset| {
        let mut own: Vec<&WorkingCandidate> = subset.members.iter().map(|&k| able[k]).collect();
        own.sort_by(|a, b| b.statistic().total_cmp(&a.statistic()));
        own.into_iter().map(|own| own.effect.id.clone()).collect()
    };
    let refitted = proposals.iter().zip(fits);
    Ok(refitted
        .filter_map(|(subset, fit)| {
            Some(JointRefit {
                members: members(subset),
                fit: fit?,
            })
        })
        .collect())
}

/// Returns the start of a joint refit: the parameters of a fit, with all effects of a combination added at
/// their jointly estimated sizes and individually best shapes.
fn started(fit: &Fit, able: &[&WorkingCandidate], subset: &Subset) -> Point {
    let mut estimates = subset.sizes.iter();
    let members = subset.members.iter().map(|&k| able[k]);
    members.fold(fit.point(), |point, one| {
        let own = sized(&one.effect, one.start.clone(), &mut estimates);
        point.with(&one.effect, &own)
    })
}
