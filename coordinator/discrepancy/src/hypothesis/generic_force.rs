//! Comparison of the best named effect of a round with generic forces, which may lead to its rejection.
//!
//! The library of effects cannot be complete. A generic force is a force of simple form across a joint (a
//! constant, a sign, a power, a harmonic) without a physical cause. If such a force, refitted with every
//! unknown free, gains as much evidence over the best named effect as the best of so many forces needs, the named
//! effect is rejected. A form whose projected signature is nearly that of a library
//! effect does not count as a challenger, because the named effect is then the better description.
use crate::baseline::session::Session;
use crate::hypothesis::candidate::{WorkingCandidate, joined};
use crate::hypothesis::round::WorkingRound;
use crate::laboratory::{Laboratory, Stage};
use crate::linear::isolability::similarity;
use crate::linear::score::{NullModel, chi_squared_tail, family_wise, score};
use crate::linear::tangent::Tangent;
use crate::model::fit::Fit;
use crate::model::probe::harmonic;
use crate::model::unknowns::Point;
use nalgebra::DMatrix;
use search::least_squares::LeastSquaresSettings;

/// Generic force under test: a single form, or both phases of a harmonic.
#[derive(Clone, Debug)]
struct Form<'a> {
    /// Components of the generic force (one, or the two phases of a harmonic), in descending order of their
    /// score-test statistic.
    parts: Vec<&'a WorkingCandidate>,
    signature: DMatrix<f64>,
    statistic: f64,
    p_value: f64,
}

impl Form<'_> {
    /// Returns the test statistic less two nats' worth of `chi^2` for each amplitude: a harmonic has two to
    /// choose.
    fn merit(&self) -> f64 {
        self.statistic - 2.0 * self.parts.len() as f64
    }

    /// Returns the force as a challenger, from its refit and the fit without it.
    fn challenger(&self, without: &Fit, fit: Fit) -> Challenger {
        Challenger {
            id: self.parts[0].effect.id.clone(),
            removed: without.chi_squared() - fit.chi_squared(),
            gained: fit.gain_over(without),
            fit,
        }
    }
}

/// Generic force that explains the residual better than every named effect.
#[derive(Clone, Debug)]
pub(crate) struct Challenger {
    /// Identifier of the form; for a harmonic that of its stronger phase.
    pub(crate) id: String,
    /// Reduction of `chi^2` by adding the force and refitting.
    pub(crate) removed: f64,
    /// Gain of log evidence over the model without the force (nats).
    pub(crate) gained: f64,
    /// Fit of the model with the force.
    pub(crate) fit: Fit,
}

/// Maximum number of generic forces that are refitted in a round.
const TRIED: usize = 3;

/// Returns the generic force that beats the best named effect of a round, if there is one.
pub(crate) async fn challenge<L: Laboratory>(
    session: &mut Session<'_, L>,
    current: &Fit,
    round: &WorkingRound,
) -> Result<Option<Challenger>, L::Error> {
    let thresholds = &session.inputs.thresholds;
    let best = round.refits.first();
    let best_name = best.map(|best| &best.fit);
    // by how much the best name lowers the misfit
    let named = best_name.map_or(0.0, |best| current.chi_squared() - best.chi_squared());
    let null = current.null_model();
    let mut forms = forms(&round.generics, &null);
    let tests = forms.len();
    let needed = thresholds.evidence_of_best(tests, 1);
    forms.retain(|form| {
        family_wise(form.p_value, tests) < thresholds.alpha
            && form.statistic > named
            && !is_listed(form, &round.candidates, thresholds.alike, &null.tangent)
    });
    forms.sort_by(|a, b| b.merit().total_cmp(&a.merit()));
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
    let best = refits
        .map(|(form, fit)| form.challenger(current, fit))
        .max_by(|a, b| a.gained.total_cmp(&b.gained));
    let beats = |own: &Challenger| {
        let over_name = own.fit.gain_over(best_name.unwrap_or(current));
        over_name >= needed && own.gained >= needed
    };
    Ok(best.filter(beats))
}

/// Model from which an effect of the answer was removed, and the generic force that takes its place.
pub(crate) struct Replacement {
    /// Fit without the effect and without the force.
    pub(crate) without: Fit,
    pub(crate) force: Challenger,
}

/// Returns the generic force that beats an effect of the answer in its place, if there is one: every other
/// part of the answer is kept, all unknowns are free, and the evidence with the force is larger by the gain
/// that an effect needs. The force must also leave less of the record, unless the effect's own size may be
/// zero (`vanishes`): a law with fewer parameters gains evidence by that alone, which is no reason against a
/// law with a cause.
pub(crate) async fn in_place<L: Laboratory>(
    session: &mut Session<'_, L>,
    answer: &Fit,
    (position, vanishes): (usize, bool),
    round: &WorkingRound,
) -> Result<Option<Replacement>, L::Error> {
    /// Minimum share of the effect's reduction of `chi^2` that the test of a force promises: with less it does
    /// not reach the effect by a refit.
    const PROMISED: f64 = 0.5;
    let thresholds = &session.inputs.thresholds;
    let without = session.fit_without(answer, position).await?;
    let Some(without) = without else {
        return Ok(None);
    };
    let reduction = without.chi_squared() - answer.chi_squared();
    let mut forms = forms(&round.generics, &without.null_model());
    let tests = forms.len();
    let needed = thresholds.evidence_of_best(tests, 1);
    forms.retain(|form| {
        family_wise(form.p_value, tests) < thresholds.alpha && form.statistic > PROMISED * reduction
    });
    forms.sort_by(|a, b| b.merit().total_cmp(&a.merit()));
    forms.truncate(TRIED);
    let starts = forms.iter().map(|form| started(&without, form)).collect();
    let mut experiments = session.experiments(Stage::Refit);
    let refits = experiments
        .fits(starts, LeastSquaresSettings::short(8))
        .await?;
    let refits = forms.iter().zip(refits);
    let refits = refits.filter_map(|(form, fit)| Some(form.challenger(&without, fit?)));
    let best = refits.max_by(|a, b| a.gained.total_cmp(&b.gained));
    let force = best.filter(|force| {
        let closer = force.fit.chi_squared() < answer.chi_squared();
        force.fit.gain_over(answer) >= needed && (closer || vanishes)
    });
    Ok(force.map(|force| Replacement { without, force }))
}

/// Returns all generic forces, with the two phases of a harmonic combined into one form.
fn forms<'a>(generics: &'a [WorkingCandidate], null: &NullModel) -> Vec<Form<'a>> {
    let form = |mut parts: Vec<&'a WorkingCandidate>| {
        parts.sort_by(|a, b| b.statistic().total_cmp(&a.statistic()));
        if parts.iter().all(|part| part.signature.ncols() == 0) {
            return None;
        }
        let signature = joined(&parts);
        let statistic = score(null, &signature, &[]).statistic;
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
        let phase = |other: &&WorkingCandidate| {
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
fn is_listed(form: &Form<'_>, named: &[WorkingCandidate], alike: f64, tangent: &Tangent) -> bool {
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
