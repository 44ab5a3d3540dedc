//! Two effects at once.
//!
//! Where two effects act, each alone may explain less than a force that resembles their sum. All pairs
//! are tried on the projected linear system (a few hundred tiny solves); what it proposes, a refit
//! with every unknown free judges.
use crate::cause::suspect::{Suspect, joined};
use crate::laboratory::Laboratory;
use crate::linear::score::score;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::model::parameter::{positive, sized};
use crate::model::unknowns::Point;
use search::least_squares::Settings;

/// Pairs that are refitted.
const TRIED: usize = 2;

/// Log evidence (nats) of the best pair of effects, refitted together; nothing where none has estimates
/// that it may have.
pub(crate) async fn best<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    fit: &Fit,
    suspects: &[Suspect],
) -> Result<Option<f64>, L::Error> {
    let proposals = propose(fit, suspects);
    let starts = proposals
        .iter()
        .map(|proposal| started(fit, proposal))
        .collect();
    let fits = experiments.fits(starts, Settings::short(6)).await?;
    let evidences = fits.iter().flatten().map(Fit::log_evidence);
    Ok(evidences.max_by(f64::total_cmp))
}

/// Two suspects with their joint linear estimate.
struct Proposal<'a> {
    members: [&'a Suspect; 2],
    size: Vec<f64>,
    merit: f64,
}

/// The pairs that explain most, to first order.
fn propose<'a>(fit: &Fit, suspects: &'a [Suspect]) -> Vec<Proposal<'a>> {
    let tangent = fit.tangent();
    let residual = &fit.search.settled_residual();
    let able = suspects.iter().filter(|s| s.signature.ncols() > 0);
    let able: Vec<&Suspect> = able.collect();
    let mut all = Vec::new();
    for (k, &a) in able.iter().enumerate() {
        for &b in &able[k + 1..] {
            let found = score(residual, &joined(&[a, b]), &[], &tangent);
            let mut signs = [a, b]
                .into_iter()
                .flat_map(|one| positive(&one.effect))
                .zip(&found.size);
            if !signs.any(|(positive, size)| positive && *size < 0.0) {
                all.push(Proposal {
                    members: [a, b],
                    merit: found.statistic - 2.0 * found.freedom as f64,
                    size: found.size,
                });
            }
        }
    }
    all.sort_by(|a, b| b.merit.total_cmp(&a.merit));
    all.truncate(TRIED);
    all
}

/// A fit with both at their estimates, in the shapes that suit each alone.
fn started(fit: &Fit, proposal: &Proposal<'_>) -> Point {
    let mut estimates = proposal.size.iter();
    proposal
        .members
        .into_iter()
        .fold(fit.point(), |point, one| {
            let own = sized(&one.effect, one.start.clone(), &mut estimates);
            point.with(&one.effect, &own)
        })
}
