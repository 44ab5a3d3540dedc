//! Forces without a cause against the best name.
//!
//! The library cannot hold everything. A force of simple form across a joint (a constant, a sign, a
//! power, a harmonic) knows no cause; where such a force, refitted with every gene free, explains much
//! more than the best name does, or leaves nothing but noise where the name does not, the name is not
//! believed. A form that a library effect *is* (its
//! projected signature is nearly the same) is no challenger: then the name is the better word for it.
use crate::bench::Fit;
use crate::evidence::{log_evidence, misfit};
use crate::isolability::likeness;
use crate::laboratory::{Laboratory, Stage};
use crate::model::Model;
use crate::score::{chi_squared_tail, family_wise, score};
use crate::settings::Settings;
use crate::stage::establish::Base;
use crate::stage::suspect::Suspect;
use crate::stage::whereabouts::probe_order;
use crate::tangent::Tangent;
use nalgebra::{DMatrix, DVector};
use search::least_squares;

/// A force without a cause: one form, or both phases of a harmonic.
#[derive(Clone, Debug)]
struct Form<'a> {
    /// Its parts, the stronger first.
    parts: Vec<&'a Suspect>,
    signature: DMatrix<f64>,
    statistic: f64,
    p_value: f64,
}

/// A force that beats every name.
#[derive(Clone, Debug)]
pub struct Challenger {
    /// Identifier of the form; of a harmonic, its stronger phase.
    pub id: String,
    /// By how much it lowers `chi^2`, refitted.
    pub removed: f64,
    /// Log evidence of the refit (nats).
    pub log_evidence: f64,
    /// The refit.
    pub fit: Fit,
}

/// What a challenger has to beat.
#[derive(Clone, Copy, Debug)]
pub struct Named<'a> {
    /// Every named effect with its test.
    pub suspects: &'a [Suspect],
    /// By how much the best name lowers `chi^2`, refitted; 0 without one.
    pub removed: f64,
    /// `chi^2` of the best name's refit, or of the fit without.
    pub left: f64,
    /// Log evidence of the best name's refit, or of the fit without.
    pub log_evidence: f64,
}

/// Forms that are refitted at most.
const TRIED: usize = 3;

/// The force that beats the best name, if there is one.
///
/// # Errors
/// Of the laboratory.
pub(crate) async fn challenge<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    fit: &Fit,
    generics: &[Suspect],
    named: &Named<'_>,
    settings: &Settings,
) -> Result<Option<Challenger>, L::Error> {
    let bench = &base.bench;
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let residual = &fit.search.settled_residual();
    let mut forms = forms(generics, residual, &tangent);
    let tests = forms.len();
    forms.retain(|form| {
        family_wise(form.p_value, tests) < settings.alpha
            && form.statistic > named.removed + settings.generic_gain
            && !is_listed(form, named.suspects, settings, &tangent)
    });
    // a harmonic has two amplitudes to choose: two nats' worth of chi^2 each
    let merit = |form: &Form<'_>| form.statistic - 2.0 * form.parts.len() as f64;
    forms.sort_by(|a, b| merit(b).total_cmp(&merit(a)));
    forms.truncate(TRIED);
    let starts: Vec<(Model, Vec<f64>)> = forms.iter().map(|form| started(fit, form)).collect();
    let how = least_squares::Settings {
        iterations: 5,
        ..least_squares::Settings::default()
    };
    let refits = bench.fit(lab, Stage::Refit, starts, how).await?;
    let best = forms
        .iter()
        .zip(refits)
        .filter_map(|(form, refit)| Some((form, refit?)))
        .min_by(|(_, a), (_, b)| a.chi_squared().total_cmp(&b.chi_squared()));
    Ok(best.and_then(|(form, refit)| {
        let phi = misfit(refit.chi_squared().min(named.left), bench.metric.len());
        let scale = phi * phi;
        let removed = fit.chi_squared() - refit.chi_squared();
        let log_evidence = log_evidence(refit.search.best(), refit.variables());
        let gain = log_evidence - named.log_evidence;
        let margin = settings.generic_gain * scale;
        let noise = |left: f64| base.is_noise(left, refit.x().len(), settings.adequacy);
        let clears = noise(refit.chi_squared()) && !noise(named.left);
        let beats = removed > settings.generic_factor * named.removed + margin
            || (clears && removed > named.removed + margin);
        let beats = beats && gain > settings.gain * scale;
        beats.then(|| Challenger {
            id: form.parts[0].effect.id.clone(),
            removed,
            log_evidence,
            fit: refit,
        })
    }))
}

/// Every form, and every harmonic with both its phases.
fn forms<'a>(generics: &'a [Suspect], residual: &DVector<f64>, tangent: &Tangent) -> Vec<Form<'a>> {
    let form = |mut parts: Vec<&'a Suspect>| {
        parts.sort_by(|a, b| b.statistic().total_cmp(&a.statistic()));
        let columns: Vec<DVector<f64>> = parts
            .iter()
            .flat_map(|part| {
                part.signature
                    .column_iter()
                    .map(nalgebra::Matrix::into_owned)
            })
            .collect();
        if columns.is_empty() {
            return None;
        }
        let signature = DMatrix::from_columns(&columns);
        let statistic = score(residual, &signature, &[], tangent, 1.0).statistic;
        Some(Form {
            p_value: chi_squared_tail(statistic, columns.len()),
            parts,
            signature,
            statistic,
        })
    };
    let mut all = Vec::new();
    for (at, generic) in generics.iter().enumerate() {
        let order = probe_order(&generic.effect.id).filter(|order| *order > 0);
        let phase = |other: &&Suspect| {
            other.effect.joint == generic.effect.joint && probe_order(&other.effect.id) == order
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

/// Whether a library effect that the record speaks for is this form.
fn is_listed(form: &Form<'_>, named: &[Suspect], settings: &Settings, tangent: &Tangent) -> bool {
    named
        .iter()
        .filter(|one| one.statistic() > 0.0 && one.signature.ncols() > 0)
        .any(|one| likeness(&form.signature, &one.signature, tangent) > settings.alike)
}

/// A fit with a form at its linear estimate.
fn started(fit: &Fit, form: &Form<'_>) -> (Model, Vec<f64>) {
    let mut model = fit.model.clone();
    let mut x = fit.x().to_vec();
    for part in &form.parts {
        model = model.with(&part.effect);
        x.extend(&part.start);
    }
    (model, x)
}
