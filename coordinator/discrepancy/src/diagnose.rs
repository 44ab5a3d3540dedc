//! A diagnosis from the record to the verdict: the order of the stages and what they hand on.
use crate::bench::{Bench, Fit};
use crate::evidence::{ambiguity_set, log_evidence, misfit};
use crate::isolability;
use crate::laboratory::{Laboratory, Stage};
use crate::metric::Metric;
use crate::model::{Model, sizes};
use crate::noise::Noise;
use crate::record::{Curves, Record};
use crate::score::family_wise;
use crate::settings::Settings;
use crate::spectrum::Orders;
use crate::stage::preflight::Preflight;
use crate::stage::refit::Refitted;
use crate::stage::show::Row;
use crate::stage::suspect::Suspect;
use crate::stage::whereabouts::Where;
use crate::stage::{basin, preflight, recalibrate, refit, show, suspect, whereabouts};
use crate::tangent::Tangent;
use crate::verdict::{Findings, Verdict, verdict};
use nalgebra::{Complex, DMatrix, DVector};
use protocol::announce::EffectDescriptor;
use protocol::job::Refinement;
use search::space::Space;

/// What is diagnosed.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Genes and their bounds.
    pub space: Space,
    /// Records, the calibrated condition's first.
    pub records: Vec<Record>,
    /// What the workers can simulate.
    pub library: Vec<EffectDescriptor>,
    /// A calibrated point (decades), if there is one.
    pub start: Option<Vec<f64>>,
    /// A finer discretisation, for the numerical check.
    pub finer: Refinement,
    /// Seed of the way into the valley.
    pub seed: u64,
    /// Thresholds.
    pub settings: Settings,
}

/// One round of suspicion.
#[derive(Clone, Debug)]
pub struct Round {
    /// Every named effect with its test, in the library's order.
    pub suspects: Vec<Suspect>,
    /// Forces without a cause, likewise.
    pub generics: Vec<Suspect>,
    /// Refits, the best first.
    pub refits: Vec<Refitted>,
    /// Log evidence without a further effect.
    pub null_evidence: f64,
    /// Misfit of the best model; variances are inflated by its square.
    pub phi: f64,
    /// Family-wise p-value of the named effects.
    pub p_value: f64,
    /// Identifiers that the record does not tell apart, the best first; empty if nothing was found.
    pub set: Vec<String>,
    /// Which effect was added, if any.
    pub added: Option<String>,
    /// Why none was.
    pub reason: Option<String>,
}

/// An effect of the answer.
#[derive(Clone, Debug, PartialEq)]
pub struct Estimate {
    /// Identifier.
    pub id: String,
    /// In words.
    pub title: String,
    /// Name, unit, value and 95 % interval of each parameter.
    pub parameters: Vec<(String, String, f64, [f64; 2])>,
    /// Family-wise p-value of its score test.
    pub p_value: f64,
    /// Log evidence against the model without it, over the squared misfit (nats).
    pub ln_evidence: f64,
}

/// From which size on an effect would have been seen.
#[derive(Clone, Debug, PartialEq)]
pub struct Limit {
    /// Identifier.
    pub id: String,
    /// Parameter.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// The size; infinite where recalibration absorbs the effect.
    pub size: f64,
}

/// A finished diagnosis.
#[derive(Clone, Debug)]
pub struct Diagnosis {
    /// The answer.
    pub verdict: Verdict,
    /// Why, in a sentence, where the answer needs one.
    pub reason: Option<String>,
    /// Added effects, then the other members of their ambiguity sets.
    pub effects: Vec<Estimate>,
    /// The rounds.
    pub rounds: Vec<Round>,
    /// Where the recalibrated model and the record part.
    pub whereabouts: Option<Where>,
    /// The numerical check.
    pub preflight: Option<Preflight>,
    /// Detection limits of all effects.
    pub limits: Vec<Limit>,
    /// Effects that this record cannot tell apart at their usual sizes.
    pub classes: Vec<Vec<String>>,
    /// The recalibrated model without effects.
    pub before: Option<Fit>,
    /// The model of the answer.
    pub after: Option<Fit>,
    /// The gap of the answer by record.
    pub rows: Vec<Row>,
    /// The best rejected rival and its gap by record.
    pub rival: Option<(String, Vec<Row>)>,
    /// Form and joint of a force that beats every name.
    pub generic: Option<String>,
    /// Whether the noise was assumed.
    pub assumed_noise: bool,
    /// What else should be known.
    pub notes: Vec<String>,
}

/// Diagnoses.
///
/// # Errors
/// Of the laboratory: nobody simulates any more, or the user stopped.
pub async fn diagnose<L: Laboratory>(lab: &mut L, inputs: &Inputs) -> Result<Diagnosis, L::Error> {
    let Some(record) = inputs.records.first().filter(|r| !r.cycles.is_empty()) else {
        return Ok(Diagnosis::unresolved(
            "there is no record of the calibrated condition",
        ));
    };
    let (fitted, held) = record.split();
    let model = Model::plain(inputs.space.clone());
    let Some(base) = establish(lab, inputs, &model, fitted).await? else {
        return Ok(Diagnosis::unresolved(
            "no point near the recommended parameters completes its simulation",
        ));
    };
    let phi = misfit(base.fit.chi_squared(), base.bench.metric.len());
    let whereabouts = whereabouts::look(
        lab,
        &base.bench,
        &base.fit,
        &inputs.library,
        (&inputs.settings, base.freedom),
        phi,
    )
    .await?;
    let mut diagnosis = Diagnosis {
        whereabouts: Some(whereabouts),
        assumed_noise: base.assumed,
        preflight: base.preflight.clone(),
        notes: base.notes.clone(),
        before: Some(base.fit.clone()),
        ..Diagnosis::unresolved("")
    };
    diagnosis.reason = None;
    let gradient = base.fit.search.gradient_ratio();
    if gradient > GRADIENT {
        diagnosis.reason = Some(format!(
            "the recalibration did not converge: a parameter still has a cosine of {gradient:.2} with \
             the residual, so a test would report calibration error"
        ));
        return Ok(diagnosis);
    }
    let after = rounds(lab, inputs, &base, &mut diagnosis).await?;
    finish(lab, inputs, &base, (after, &held), &mut diagnosis).await?;
    Ok(diagnosis)
}

/// Beyond this cosine a fit has not converged.
const GRADIENT: f64 = 0.05;

/// The recalibrated model in its final metric.
struct Base {
    bench: Bench,
    fit: Fit,
    preflight: Option<Preflight>,
    assumed: bool,
    freedom: f64,
    notes: Vec<String>,
}

/// Noise, way into the valley, recalibration, numerical check, final metric, final fit.
async fn establish<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    model: &Model,
    record: Record,
) -> Result<Option<Base>, L::Error> {
    let orders = Orders::new(record.samples(), inputs.settings.orders);
    let channels = record.channels.len();
    let rough = Noise::estimate(&record, &orders, &[]);
    let metric = Metric::new(orders.clone(), channels, &rough.covariances);
    let bench = Bench::new(record.clone(), metric, Refinement::default());
    let starts = match &inputs.start {
        Some(start) => vec![start.clone()],
        None => basin::enter(lab, &bench, model, inputs.seed).await?,
    };
    let Some(first) = recalibrate::from_starts(lab, &bench, model, starts).await? else {
        return Ok(None);
    };
    let inputs_of_cycles = input_curves(lab, &bench, &first, &inputs.library).await?;
    let spectra: Vec<Vec<Vec<Complex<f64>>>> = inputs_of_cycles
        .iter()
        .map(|(curves, _)| curves.iter().map(|curve| orders.transform(curve)).collect())
        .collect();
    let mut noise = Noise::estimate(&record, &orders, &spectra);
    let weigh = |noise: &Noise| {
        let mut metric = Metric::new(orders.clone(), channels, &noise.covariances);
        let directions: Vec<DVector<f64>> = inputs_of_cycles
            .iter()
            .map(|(curves, deviation)| metric.whiten(curves) * *deviation)
            .collect();
        metric.marginalize(&directions);
        Bench::new(record.clone(), metric, Refinement::default())
    };
    let bench = weigh(&noise);
    let Some(second) = recalibrate::converge(lab, &bench, model, first.x()).await? else {
        return Ok(None);
    };
    let preflight = preflight::check(lab, &bench, &second, inputs.finer).await?;
    let mut notes = Vec::new();
    let (bench, fit) = match &preflight {
        Some(seen) => {
            noise.add_error(&seen.left);
            let bench = weigh(&noise);
            match recalibrate::converge(lab, &bench, model, second.x()).await? {
                Some(fit) => (bench, fit),
                None => return Ok(None),
            }
        }
        None => {
            notes.push(
                "the finer model did not complete: the numerical error is unknown".to_owned(),
            );
            (bench, second)
        }
    };
    Ok(Some(Base {
        bench,
        fit,
        preflight,
        assumed: noise.assumed,
        freedom: noise.freedom,
        notes,
    }))
}

/// Curves by which cycles differ because their input did, per unit of it, with the standard deviation
/// of the mean over the cycles: the crank angle (deg) and the load's scale.
async fn input_curves<L: Laboratory>(
    lab: &mut L,
    bench: &Bench,
    fit: &Fit,
    library: &[EffectDescriptor],
) -> Result<Vec<(Curves, f64)>, L::Error> {
    let stated = &bench.record.stated;
    let cycles = (bench.record.cycles.len().max(1) as f64).sqrt();
    let mut inputs = Vec::new();
    if stated.angle_tolerance_deg > 0.0 {
        let orders = bench.metric.orders();
        let slope = |curve: &Vec<f64>| {
            let spectrum: Vec<Complex<f64>> = orders
                .transform(curve)
                .iter()
                .enumerate()
                .map(|(k, f)| f * Complex::new(0.0, (k + 1) as f64 * 1.0_f64.to_radians()))
                .collect();
            orders.curve(&spectrum)
        };
        // a tolerance bounds a uniform distribution
        let deviation = stated.angle_tolerance_deg / 3.0_f64.sqrt() / cycles;
        inputs.push((fit.curves.iter().map(slope).collect(), deviation));
    }
    let gain = library.iter().find(|effect| effect.id == "load_cell_gain");
    if let Some(gain) = gain.filter(|_| stated.load_scatter > 0.0)
        && let Some(&k) = sizes(gain).first()
    {
        let p = &gain.parameters[k];
        let mut x = fit.x().to_vec();
        let mut own = crate::model::absent(gain);
        own[k] = (p.typical - p.absent) / p.scale;
        x.extend(own);
        let model = fit.model.with(gain);
        let seen = bench
            .curves(lab, Stage::Recalibrate, &[(&model, &x)])
            .await?;
        if let Some(curves) = seen.into_iter().next().flatten() {
            let per_unit = |(a, b): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
                a.iter()
                    .zip(b)
                    .map(|(a, b)| (a - b) / (p.typical - p.absent))
                    .collect()
            };
            let curves = curves.iter().zip(&fit.curves).map(per_unit).collect();
            inputs.push((curves, stated.load_scatter / cycles));
        }
    }
    Ok(inputs)
}

/// Rounds of suspicion until nothing is gained; the model of the answer.
async fn rounds<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    base: &Base,
    diagnosis: &mut Diagnosis,
) -> Result<Fit, L::Error> {
    let settings = &inputs.settings;
    let considered = |effect: &&EffectDescriptor| !settings.without.contains(&effect.id);
    let (generic, named): (Vec<EffectDescriptor>, Vec<EffectDescriptor>) = inputs
        .library
        .iter()
        .filter(considered)
        .cloned()
        .partition(|effect| effect.generic);
    let mut current = base.fit.clone();
    for number in 0..settings.rounds {
        let open: Vec<EffectDescriptor> = named
            .iter()
            .filter(|effect| current.model.added.iter().all(|a| a.id != effect.id))
            .cloned()
            .collect();
        let mut round = examine(lab, base, &current, (&open, &generic), settings).await?;
        if number == 0 {
            (diagnosis.limits, diagnosis.classes) = outlook(&round, &current, base);
        }
        let next = decide(&mut round, &current, settings, base);
        if round.added.is_none() && number == 0 {
            diagnosis.generic = challenge(lab, base, &current, &round, &generic, settings).await?;
        }
        diagnosis.rounds.push(round);
        match next {
            Some(fit) => current = fit,
            None => break,
        }
    }
    Ok(current)
}

/// Tests everything that is not in the model yet, and refits the suspects.
async fn examine<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    current: &Fit,
    (named, generic): (&[EffectDescriptor], &[EffectDescriptor]),
    settings: &Settings,
) -> Result<Round, L::Error> {
    let suspects = suspect::examine(lab, &base.bench, current, named, 1.0).await?;
    let generics = suspect::examine(lab, &base.bench, current, generic, 1.0).await?;
    let mut order: Vec<&Suspect> = suspects.iter().filter(|s| s.statistic() > 0.0).collect();
    order.sort_by(|a, b| {
        a.p_value()
            .total_cmp(&b.p_value())
            .then(b.statistic().total_cmp(&a.statistic()))
    });
    order.truncate(settings.suspects);
    let mut refits = refit::refit(lab, &base.bench, current, &order).await?;
    refits.sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
    let best = refits
        .first()
        .map_or(current.chi_squared(), |r| r.fit.chi_squared());
    let phi = misfit(best.min(current.chi_squared()), base.bench.metric.len());
    let least = suspects
        .iter()
        .filter_map(|s| Some((s.score.as_ref()?, s.tries)))
        .map(|(score, tries)| {
            let tail = crate::score::chi_squared_tail(score.statistic / (phi * phi), score.freedom);
            family_wise(tail.min(score.p_value.max(tail)), tries)
        })
        .fold(1.0, f64::min);
    Ok(Round {
        p_value: family_wise(least, suspects.len()),
        null_evidence: log_evidence(current.search.best(), current.variables()),
        suspects,
        generics,
        refits,
        phi,
        set: Vec::new(),
        added: None,
        reason: None,
    })
}

/// Whether the best refit is believed; then it is the next model.
fn decide(round: &mut Round, current: &Fit, settings: &Settings, base: &Base) -> Option<Fit> {
    let best = round.refits.first()?;
    let scale = round.phi * round.phi;
    let gain = (best.log_evidence - round.null_evidence) / scale;
    if round.p_value > settings.alpha || gain < settings.gain {
        round.reason = Some(format!(
            "{} is the likeliest, but p = {:.2} over the family and {gain:.1} nats are not enough",
            best.id, round.p_value
        ));
        return None;
    }
    let evidences: Vec<f64> = round.refits.iter().map(|r| r.log_evidence).collect();
    round.set = ambiguity_set(&evidences, round.phi)
        .into_iter()
        .map(|i| round.refits[i].id.clone())
        .collect();
    let removed = (current.chi_squared() - best.fit.chi_squared())
        / (current.chi_squared() - base.bench.metric.len() as f64).max(1.0);
    if removed < settings.practical {
        round.reason = Some(format!(
            "{} is there, but a trace: it removes {:.1} % of what is left above the noise",
            best.id,
            100.0 * removed
        ));
        round.set.clear();
        return None;
    }
    round.added = Some(best.id.clone());
    Some(best.fit.clone())
}

/// A force without a cause that explains more than every name: its identifier.
async fn challenge<L: Laboratory>(
    _lab: &mut L,
    _base: &Base,
    current: &Fit,
    round: &Round,
    _generic: &[EffectDescriptor],
    settings: &Settings,
) -> Result<Option<String>, L::Error> {
    let best = round
        .refits
        .first()
        .map_or(0.0, |r| current.chi_squared() - r.fit.chi_squared());
    let scale = round.phi * round.phi;
    let likeliest = round
        .generics
        .iter()
        .filter(|g| {
            family_wise(
                crate::score::chi_squared_tail(g.statistic() / scale, 1),
                round.generics.len(),
            ) < settings.alpha
        })
        .max_by(|a, b| a.statistic().total_cmp(&b.statistic()));
    Ok(likeliest
        .filter(|g| g.statistic() > settings.generic_factor * best + 10.0 * scale)
        .map(|g| g.effect.id.clone()))
}

/// Detection limits and classes of effects, before any verdict.
fn outlook(round: &Round, fit: &Fit, base: &Base) -> (Vec<Limit>, Vec<Vec<String>>) {
    let tangent = Tangent::new(fit.search.best(), fit.variables());
    let phi = misfit(fit.chi_squared(), base.bench.metric.len());
    let mut limits = Vec::new();
    let mut known: Vec<(String, DMatrix<f64>)> = Vec::new();
    for suspect in &round.suspects {
        if suspect.signature.ncols() == 0 {
            continue;
        }
        known.push((suspect.effect.id.clone(), suspect.signature.clone()));
        for (column, k) in sizes(&suspect.effect).into_iter().enumerate() {
            let one = suspect.signature.columns(column, 1).into_owned();
            let parameter = &suspect.effect.parameters[k];
            limits.push(Limit {
                id: suspect.effect.id.clone(),
                parameter: parameter.name.clone(),
                unit: parameter.unit.clone(),
                size: phi * isolability::detection_limit(&one, &tangent) * parameter.scale,
            });
        }
    }
    let signatures: Vec<DMatrix<f64>> = known.iter().map(|(_, g)| g.clone()).collect();
    let distances = isolability::distances(&signatures, &tangent);
    let classes = isolability::classes(&distances);
    let name = |members: Vec<usize>| members.into_iter().map(|i| known[i].0.clone()).collect();
    (limits, classes.into_iter().map(name).collect())
}

/// Estimates, the proof and the verdict.
async fn finish<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    base: &Base,
    (after, held): (Fit, &Record),
    diagnosis: &mut Diagnosis,
) -> Result<(), L::Error> {
    let mut records: Vec<(&Record, bool)> = vec![(&base.bench.record, true), (held, false)];
    records.extend(inputs.records.iter().skip(1).map(|record| (record, false)));
    records.retain(|(record, _)| !record.cycles.is_empty());
    let refinement = base.bench.refinement;
    let added = after.model.added.len();
    diagnosis.rows = show::compare(lab, &records, (&base.fit, &after), refinement).await?;
    let rival = diagnosis.rounds.first().and_then(|round| {
        let outside = round.refits.iter().find(|r| !round.set.contains(&r.id));
        outside.or_else(|| round.refits.get(1)).cloned()
    });
    if let Some(rival) = rival.filter(|_| added > 0) {
        let rows = show::compare(lab, &records, (&base.fit, &rival.fit), refinement).await?;
        diagnosis.rival = Some((rival.id, rows));
    }
    diagnosis.effects = estimates(diagnosis);
    let findings = Findings {
        sound: true,
        rejected: diagnosis
            .rounds
            .first()
            .is_some_and(|r| r.p_value < inputs.settings.alpha),
        added,
        rivals: diagnosis
            .rounds
            .iter()
            .map(|r| r.set.len())
            .max()
            .unwrap_or(0),
        generic: diagnosis.generic.is_some(),
    };
    diagnosis.verdict = verdict(&findings);
    if diagnosis.verdict == Verdict::Unresolved {
        diagnosis.reason = diagnosis.rounds.first().and_then(|r| r.reason.clone());
    }
    diagnosis.after = Some(after);
    Ok(())
}

/// The added effects with their sizes, then the other members of their sets.
fn estimates(diagnosis: &Diagnosis) -> Vec<Estimate> {
    let mut found: Vec<Estimate> = Vec::new();
    for added_first in [true, false] {
        for round in &diagnosis.rounds {
            let members = round
                .set
                .iter()
                .filter(|id| (round.added.as_ref() == Some(id)) == added_first);
            for id in members {
                let refitted = round.refits.iter().find(|r| r.id == *id);
                if let Some(refitted) = refitted.filter(|_| found.iter().all(|e| e.id != *id)) {
                    found.push(estimate(round, refitted));
                }
            }
        }
    }
    found
}

fn estimate(round: &Round, refitted: &Refitted) -> Estimate {
    let model = &refitted.fit.model;
    let position = model.added.len() - 1;
    let effect = &model.added[position];
    let first = model.first_of(position);
    let deviations = deviations(&refitted.fit, round.phi);
    let parameters = effect.parameters.iter().enumerate().map(|(k, p)| {
        let x = refitted.fit.x()[first + k];
        let half = 1.96 * deviations[first + k] * p.scale;
        let value = (p.absent + x * p.scale).clamp(p.lower, p.upper);
        let interval = [(value - half).max(p.lower), (value + half).min(p.upper)];
        (p.name.clone(), p.unit.clone(), value, interval)
    });
    Estimate {
        id: refitted.id.clone(),
        title: effect.title.clone(),
        parameters: parameters.collect(),
        p_value: round
            .suspects
            .iter()
            .find(|s| s.effect.id == refitted.id)
            .map_or(1.0, |s| family_wise(s.p_value(), round.suspects.len())),
        ln_evidence: (refitted.log_evidence - round.null_evidence) / (round.phi * round.phi),
    }
}

/// Standard deviations of a fit's unknowns, inflated by the misfit.
fn deviations(fit: &Fit, phi: f64) -> Vec<f64> {
    let at = fit.search.best();
    let mut curvature = at.jacobian.tr_mul(&at.jacobian);
    for (k, v) in fit.variables().iter().enumerate() {
        if let Some(prior) = v.prior {
            curvature[(k, k)] += 1.0 / (prior.deviation * prior.deviation);
        }
    }
    let n = curvature.nrows();
    curvature.cholesky().map_or_else(
        || vec![f64::INFINITY; n],
        |factor| {
            factor
                .inverse()
                .diagonal()
                .iter()
                .map(|v| phi * v.sqrt())
                .collect()
        },
    )
}

impl Diagnosis {
    /// Nothing but a reason.
    fn unresolved(reason: &str) -> Self {
        Self {
            verdict: Verdict::Unresolved,
            reason: Some(reason.to_owned()),
            effects: Vec::new(),
            rounds: Vec::new(),
            whereabouts: None,
            preflight: None,
            limits: Vec::new(),
            classes: Vec::new(),
            before: None,
            after: None,
            rows: Vec::new(),
            rival: None,
            generic: None,
            assumed_noise: false,
            notes: Vec::new(),
        }
    }
}
