//! Rounds of suspicion: test everything, refit the likeliest, let forces without a cause challenge them,
//! believe the best or stop; at the end, take back what is not needed any more.
use crate::bench::Fit;
use crate::decide::decide;
use crate::diagnose::{Diagnosis, Inputs};
use crate::estimate::limits;
use crate::evidence::{log_evidence, misfit};
use crate::force::force;
use crate::laboratory::{Laboratory, Stage};
use crate::score::{chi_squared_tail, family_wise};
use crate::settings::Settings;
use crate::stage::challenge::{Challenger, Named, challenge};
use crate::stage::establish::Base;
use crate::stage::preflight::Checked;
use crate::stage::refit::Refitted;
use crate::stage::suspect::Suspect;
use crate::stage::{again, pair, preflight, refit, suspect, worth};
use protocol::announce::EffectDescriptor;
use search::least_squares;

/// Rounds in which the valley is looked for.
const LOOKS: usize = 2;
/// Suspects that are refitted in any case.
const RIVALS: usize = 3;

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

/// Rounds of suspicion until nothing is gained; the model of the answer.
pub(crate) async fn rounds<L: Laboratory>(
    lab: &mut L,
    inputs: &Inputs,
    base: &Base,
    diagnosis: &mut Diagnosis,
) -> Result<Fit, L::Error> {
    let settings = &inputs.settings;
    let (generic, named): (Vec<EffectDescriptor>, Vec<EffectDescriptor>) = inputs
        .considered()
        .cloned()
        .partition(|effect| effect.generic);
    let mut current = base.fit.clone();
    let mut in_valley = false;
    for number in 0..settings.rounds {
        let open: Vec<EffectDescriptor> = named
            .iter()
            .filter(|effect| current.model.added.iter().all(|a| a.id != effect.id))
            .cloned()
            .collect();
        let mut round = examine(lab, base, &current, (&open, &generic), settings).await?;
        // the valley does not move far once it is found; a second effect may hide it from the first
        if !in_valley && number < LOOKS {
            in_valley = again::look(lab, base, (&current, &mut round), inputs).await?;
        }
        if number == 0 {
            diagnosis.limits = limits(&round, &current, base, settings);
            let others = inputs.records.iter().skip(1);
            let about = (&round, diagnosis.limits.as_slice());
            diagnosis.look_alikes = worth::weigh(lab, base, &current, about, others).await?;
        }
        let next = match contested(lab, base, &current, &round, settings).await? {
            Some(challenger) => {
                let gained = challenger.log_evidence - round.null_evidence;
                let fits = (&current, &challenger.fit);
                let checked = preflight::believed(lab, base, fits, gained, inputs.finer).await?;
                match drowned(&challenger.id, checked, (settings, diagnosis)) {
                    Some(reason) => round.reason = Some(reason),
                    None => unlisted(&mut round, challenger, (&base.fit, &current), diagnosis),
                }
                None
            }
            None => decide(&mut round, &current, settings, base),
        };
        let next = match next {
            Some(fit) => {
                hold(
                    lab,
                    (base, inputs),
                    (&current, fit),
                    (&mut round, diagnosis),
                )
                .await?
            }
            None => None,
        };
        diagnosis.rounds.push(round);
        match next {
            Some(fit) => current = fit,
            None => break,
        }
    }
    let added = current.model.added.len();
    let answer = prune(lab, base, current, (settings, diagnosis)).await?;
    if answer.model.added.len() < added {
        let fits = (&answer, &base.fit);
        diagnosis.preflight_after = preflight::check(lab, &base.bench, fits, inputs.finer).await?;
    }
    Ok(answer)
}

/// The next model, if it is still believed when what a finer model changes of it counts as noise.
async fn hold<L: Laboratory>(
    lab: &mut L,
    (base, inputs): (&Base, &Inputs),
    (current, next): (&Fit, Fit),
    (round, diagnosis): (&mut Round, &mut Diagnosis),
) -> Result<Option<Fit>, L::Error> {
    let gained = log_evidence(next.search.best(), next.variables()) - round.null_evidence;
    let fits = (current, &next);
    let checked = preflight::believed(lab, base, fits, gained, inputs.finer).await?;
    let id = round.added.clone().unwrap_or_default();
    let Some(reason) = drowned(&id, checked, (&inputs.settings, diagnosis)) else {
        return Ok(Some(next));
    };
    round.added = None;
    round.set.clear();
    round.reason = Some(reason);
    Ok(None)
}

/// Why what a finer model says of an answer is enough to doubt it, if it is; the check is kept.
fn drowned(
    id: &str,
    checked: Option<Checked>,
    (settings, diagnosis): (&Settings, &mut Diagnosis),
) -> Option<String> {
    let Checked { preflight, gain } = checked?;
    diagnosis.preflight_after = Some(preflight);
    (gain < settings.gain).then(|| {
        format!(
            "{id} is the likeliest, but its gain drowns in the numerical error: with what a finer \
             model changes there as noise, {gain:.1} nats are left and {:.0} are needed",
            settings.gain
        )
    })
}

/// A force that beats the best name, and the best two names together.
async fn contested<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    current: &Fit,
    round: &Round,
    settings: &Settings,
) -> Result<Option<Challenger>, L::Error> {
    let best = round.refits.first();
    let left = best.map_or(f64::INFINITY, |r| r.fit.chi_squared());
    let named = Named {
        suspects: &round.suspects,
        removed: (current.chi_squared() - left).max(0.0),
        left: left.min(current.chi_squared()),
        log_evidence: best
            .map_or(f64::NEG_INFINITY, |r| r.log_evidence)
            .max(round.null_evidence),
    };
    let generics = &round.generics;
    let found = challenge(lab, base, current, generics, &named, settings).await?;
    let Some(challenger) = found else {
        return Ok(None);
    };
    // two effects at once may look like a third thing to each of them
    let pair = pair::best(lab, &base.bench, current, &round.suspects).await?;
    let phi = misfit(challenger.fit.chi_squared(), base.bench.metric.len());
    let margin = settings.gain * phi * phi;
    let explained = pair.is_some_and(|pair| pair.log_evidence > challenger.log_evidence - margin);
    Ok((!explained).then_some(challenger))
}

/// Takes back, one by one, effects that are no longer needed beside the others: those without which
/// the evidence falls by less than it must rise for an effect to be added.
async fn prune<L: Laboratory>(
    lab: &mut L,
    base: &Base,
    mut current: Fit,
    (settings, diagnosis): (&Settings, &mut Diagnosis),
) -> Result<Fit, L::Error> {
    while current.model.added.len() > 1 {
        let starts = (0..current.model.added.len())
            .map(|position| {
                let first = current.model.first_of(position);
                let own = first..first + current.model.added[position].parameters.len();
                let mut x = current.x().to_vec();
                x.drain(own);
                (current.model.without(position), x)
            })
            .collect();
        let how = least_squares::Settings {
            iterations: 6,
            ..least_squares::Settings::default()
        };
        let fits = base.bench.fit(lab, Stage::Refit, starts, how).await?;
        let evidence = |fit: &Fit| log_evidence(fit.search.best(), fit.variables());
        let best = fits
            .into_iter()
            .enumerate()
            .filter_map(|(position, fit)| Some((position, fit?)))
            .max_by(|(_, a), (_, b)| evidence(a).total_cmp(&evidence(b)));
        let phi = misfit(current.chi_squared(), base.bench.metric.len());
        let Some((position, fit)) = best else { break };
        if evidence(&current) - evidence(&fit) >= settings.gain * phi * phi {
            break;
        }
        let id = &current.model.added[position].id;
        for round in &mut diagnosis.rounds {
            if round.added.as_ref() == Some(id) {
                round.added = None;
                round.set.clear();
                round.reason = Some(format!("{id} is not needed beside what was added later"));
            }
        }
        current = fit;
    }
    Ok(current)
}

/// A force without a cause beats every name of this round. Beside names that explain more than it
/// does it is a remark: what is left there may be the laws of those names, a little otherwise.
fn unlisted(
    round: &mut Round,
    challenger: Challenger,
    (before, current): (&Fit, &Fit),
    diagnosis: &mut Diagnosis,
) {
    let named = before.chi_squared() - current.chi_squared();
    let said = format!(
        "a force {} explains more of what is left than any name",
        challenger.id
    );
    if challenger.removed > named {
        diagnosis.generic = Some(challenger.id.clone());
        diagnosis.force = Some(force(challenger, current, round));
    } else {
        diagnosis.notes.push(said.clone());
    }
    round.reason = Some(said);
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
    // what its own test does not speak for is refitted only to have rivals
    let clear = order.iter().filter(|s| s.p_value() < settings.alpha);
    let worth = clear.count().clamp(RIVALS, settings.suspects.max(RIVALS));
    order.truncate(worth);
    let refits = refit::refit(lab, &base.bench, current, &order).await?;
    let mut round = Round {
        p_value: 1.0,
        null_evidence: log_evidence(current.search.best(), current.variables()),
        suspects,
        generics,
        refits,
        phi: 1.0,
        set: Vec::new(),
        added: None,
        reason: None,
    };
    round.judge(current, base.bench.metric.len());
    Ok(round)
}

impl Round {
    /// Ranks the refits, and derives the misfit of the best and the family's p-value under it; `n` is
    /// the length of the residual.
    pub(crate) fn judge(&mut self, current: &Fit, n: usize) {
        self.refits
            .sort_by(|a, b| b.log_evidence.total_cmp(&a.log_evidence));
        let left = current.chi_squared();
        let best = self.refits.first().map_or(left, |r| r.fit.chi_squared());
        self.phi = misfit(best.min(left), n);
        let scale = self.phi * self.phi;
        let least = self
            .suspects
            .iter()
            .filter_map(|s| Some((s.score.as_ref()?, s.tries)))
            .map(|(score, tries)| {
                let tail = chi_squared_tail(score.statistic / scale, score.freedom);
                // an estimate of the wrong sign speaks against its effect
                let own = if score.p_value < 1.0 { tail } else { 1.0 };
                family_wise(own, tries)
            })
            .fold(1.0, f64::min);
        // no test at all rejects nothing
        self.p_value = family_wise(least, self.suspects.len().max(1));
    }
}
