//! Two effects at once.
//!
//! Where two effects act, each alone may explain less than a force that resembles their sum. All pairs
//! are tried on the projected linear system (a few hundred tiny solves); what it proposes, a refit
//! with every gene free judges.
use crate::bench::{Bench, Fit};
use crate::evidence::log_evidence;
use crate::laboratory::{Laboratory, Stage};
use crate::model::{Model, bounds, sizes};
use crate::score::score;
use crate::stage::suspect::Suspect;
use crate::tangent::Tangent;
use nalgebra::{DMatrix, DVector};
use protocol::announce::Sign;
use search::least_squares;

/// Two effects, refitted together.
#[derive(Clone, Debug)]
pub struct Pair {
    /// Their identifiers.
    pub ids: [String; 2],
    /// Log evidence (nats).
    pub log_evidence: f64,
}

/// Pairs that are refitted.
const TRIED: usize = 2;

/// The best pair of effects; nothing where none has estimates that it may have.
///
/// # Errors
/// Of the laboratory.
pub async fn best<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    suspects: &[Suspect],
) -> Result<Option<Pair>, L::Error> {
    let proposals = propose(fit, suspects);
    let starts = proposals
        .iter()
        .map(|proposal| started(fit, proposal))
        .collect();
    let how = least_squares::Settings {
        iterations: 6,
        ..least_squares::Settings::default()
    };
    let fits = bench.fit(lab, Stage::Refit, starts, how).await?;
    let pairs = proposals.iter().zip(fits).filter_map(|(proposal, fit)| {
        let fit = fit?;
        Some(Pair {
            ids: proposal.members.map(|one| one.effect.id.clone()),
            log_evidence: log_evidence(fit.search.best(), fit.variables()),
        })
    });
    Ok(pairs.max_by(|a, b| a.log_evidence.total_cmp(&b.log_evidence)))
}

/// Two suspects with their joint linear estimate.
struct Proposal<'a> {
    members: [&'a Suspect; 2],
    size: Vec<f64>,
    merit: f64,
}

fn propose<'a>(fit: &Fit, suspects: &'a [Suspect]) -> Vec<Proposal<'a>> {
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let residual = &fit.search.settled_residual();
    let able: Vec<&Suspect> = suspects
        .iter()
        .filter(|s| s.signature.ncols() > 0)
        .collect();
    let mut all = Vec::new();
    for (k, &a) in able.iter().enumerate() {
        for &b in &able[k + 1..] {
            let columns = a.signature.column_iter().chain(b.signature.column_iter());
            let columns: Vec<DVector<f64>> = columns.map(nalgebra::Matrix::into_owned).collect();
            let signature = DMatrix::from_columns(&columns);
            let found = score(residual, &signature, &[], &tangent, 1.0);
            let signs = [a, b].into_iter().flat_map(|one| {
                let own = sizes(&one.effect).into_iter();
                own.map(|k| one.effect.parameters[k].sign == Sign::Positive)
            });
            if !signs
                .zip(&found.size)
                .any(|(positive, size)| positive && *size < 0.0)
            {
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
fn started(fit: &Fit, proposal: &Proposal<'_>) -> (Model, Vec<f64>) {
    let mut model = fit.model.clone();
    let mut x = fit.x().to_vec();
    let mut estimates = proposal.size.iter();
    for one in proposal.members {
        let mut own = one.start.clone();
        for (k, estimate) in sizes(&one.effect).into_iter().zip(estimates.by_ref()) {
            let [lower, upper] = bounds(&one.effect.parameters[k]);
            own[k] = estimate.clamp(lower, upper);
        }
        model = model.with(&one.effect);
        x.extend(own);
    }
    (model, x)
}
