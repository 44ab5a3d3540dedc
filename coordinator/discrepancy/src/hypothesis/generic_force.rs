//! Comparison of the best named effect of a round with generic forces, which may lead to its rejection.
//!
//! The library of effects cannot be complete. A generic force is a force of simple form across a joint (a
//! constant, a sign, a power, a harmonic) without a physical cause. If such a force, refitted with every
//! unknown free, explains much more than the best named effect, or leaves only noise where the named effect
//! does not, the named effect is rejected. A form whose projected signature is nearly that of a library
//! effect does not count as a challenger, because the named effect is then the better description.
use crate::baseline::session::Session;
use crate::hypothesis::candidate::{CandidateEffect, joined};
use crate::hypothesis::round::Round;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::isolability::similarity;
use crate::linear::score::{chi_squared_tail, family_wise, score};
use crate::linear::tangent::Tangent;
use crate::model::fit::Fit;
use crate::model::probe::harmonic;
use crate::model::unknowns::Point;
use nalgebra::{DMatrix, DVector};
use search::least_squares::LeastSquaresSettings;

/// Generic force under test: a single form, or both phases of a harmonic.
#[derive(Clone, Debug)]
struct Form<'a> {
    /// Components of the generic force (one, or the two phases of a harmonic), in descending order of their
    /// score-test statistic.
    parts: Vec<&'a CandidateEffect>,
    signature: DMatrix<f64>,
    statistic: f64,
    p_value: f64,
}

/// Generic force that explains the residual better than every named effect.
#[derive(Clone, Debug)]
pub(crate) struct Challenger {
    /// Identifier of the form; for a harmonic that of its stronger phase.
    pub(crate) id: String,
    /// Reduction of `chi^2` by adding the force and refitting.
    pub(crate) removed: f64,
    /// Log evidence of the model refitted with the force (nats).
    pub(crate) log_evidence: f64,
    /// Fit of the model with the force.
    pub(crate) fit: Fit,
}

/// Maximum number of generic forces that are refitted in a round.
const TRIED: usize = 3;

/// Returns the generic force that beats the best named effect of a round, if there is one.
pub(crate) async fn challenge<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &Round,
) -> Result<Option<Challenger>, L::Error> {
    let (base, thresholds) = (session.base, &session.inputs.thresholds);
    let best = round.refits.first();
    let best_name = best.map(|best| &best.fit);
    // what the best name leaves, by how much it lowers the misfit, and its evidence; without a name,
    // those of the model without
    let left = best.map_or(f64::INFINITY, |best| best.fit.chi_squared());
    let named = (current.chi_squared() - left).max(0.0);
    let left = left.min(current.chi_squared());
    let evidence = best.map_or(f64::NEG_INFINITY, |best| best.log_evidence);
    let evidence = evidence.max(round.null_evidence);

    let tangent = current.tangent();
    let residual = &current.search.linear_minimum_residual();
    let mut forms = forms(&round.generics, residual, &tangent);
    let tests = forms.len();
    forms.retain(|form| {
        family_wise(form.p_value, tests) < thresholds.alpha
            && form.statistic > named + thresholds.generic_gain
            && !is_listed(form, &round.candidates, thresholds.alike, &tangent)
    });
    // a harmonic has two amplitudes to choose: two nats' worth of chi^2 each
    let merit = |form: &Form<'_>| form.statistic - 2.0 * form.parts.len() as f64;
    forms.sort_by(|a, b| merit(b).total_cmp(&merit(a)));
    forms.truncate(TRIED);
    let starts = forms.iter().map(|form| started(current, form)).collect();
    let mut experiments = session.experiments(Stage::Refit);
    let refits = experiments
        .fits(starts, LeastSquaresSettings::short(5))
        .await?;
    let refits = forms
        .iter()
        .zip(refits)
        .filter_map(|(form, refit)| Some((form, refit?)));
    let best = refits.min_by(|(_, a), (_, b)| a.chi_squared().total_cmp(&b.chi_squared()));
    Ok(best.and_then(|(form, fit)| {
        let named_best = best_name.map_or(f64::INFINITY, Fit::dispersion);
        let scale = fit.dispersion().min(named_best).min(current.dispersion());
        let removed = current.chi_squared() - fit.chi_squared();
        let log_evidence = fit.log_evidence();
        let margin = thresholds.generic_gain * scale;
        let noise =
            |left: f64| base.is_noise(left, fit.tangent().parameters(), thresholds.adequacy);
        let clears = noise(fit.chi_squared()) && !noise(left);
        let beats = removed > thresholds.generic_factor * named + margin
            || (clears && removed > named + margin);
        let beats = beats && log_evidence - evidence > thresholds.gain * scale;
        beats.then(|| Challenger {
            id: form.parts[0].effect.id.clone(),
            removed,
            log_evidence,
            fit,
        })
    }))
}

/// Returns all generic forces, with the two phases of a harmonic combined into one form.
fn forms<'a>(
    generics: &'a [CandidateEffect],
    residual: &DVector<f64>,
    tangent: &Tangent,
) -> Vec<Form<'a>> {
    let form = |mut parts: Vec<&'a CandidateEffect>| {
        parts.sort_by(|a, b| b.statistic().total_cmp(&a.statistic()));
        if parts.iter().all(|part| part.signature.ncols() == 0) {
            return None;
        }
        let signature = joined(&parts);
        let statistic = score(residual, &signature, &[], tangent).statistic;
        Some(Form {
            p_value: chi_squared_tail(statistic, signature.ncols()),
            parts,
            signature,
            statistic,
        })
    };
    let mut all = Vec::new();
    for (at, generic) in generics.iter().enumerate() {
        let order = harmonic(&generic.effect.id);
        let phase = |other: &&CandidateEffect| {
            other.effect.joint == generic.effect.joint && harmonic(&other.effect.id) == order
        };
        match order {
            None => all.extend(form(vec![generic])),
            // the first of the two phases stands for both
            Some(_) if generics[..at].iter().any(|other| phase(&other)) => {}
            Some(_) => all.extend(form(generics[at..].iter().filter(phase).collect())),
        }
    }
    all
}

/// Returns whether a library effect with a positive statistic has nearly the signature of this form.
fn is_listed(form: &Form<'_>, named: &[CandidateEffect], alike: f64, tangent: &Tangent) -> bool {
    let mut spoken = named
        .iter()
        .filter(|one| one.statistic() > 0.0 && one.signature.ncols() > 0);
    spoken.any(|one| similarity(&form.signature, &one.signature, tangent) > alike)
}

/// Returns the parameters of a fit with a generic force added at its linearly estimated size.
fn started(fit: &Fit, form: &Form<'_>) -> Point {
    let parts = form.parts.iter();
    parts.fold(fit.point(), |point, part| {
        point.with(&part.effect, &part.start)
    })
}
