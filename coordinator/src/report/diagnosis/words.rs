//! What a diagnosis says, in sentences: verdict, confidence, what to do next.
//!
//! Judges nothing: every number is the diagnosis' own.
use super::Subject;
use crate::report::number::{NONE, figure, fixed, percent, quantity};
use crate::report::words::condition_name;
use discrepancy::diagnose::{Diagnosis, Estimate, Limit, Round};
use discrepancy::record::{Record, Source};
use discrepancy::stage::show::Row;
use discrepancy::verdict::Verdict;
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Role};

/// A p-value; below what its law can promise, only that.
pub(super) fn p_value(p: f64) -> String {
    if p.is_finite() && p < 1e-12 {
        "< 10⁻¹²".to_owned()
    } else {
        figure(p)
    }
}

/// Nats with one decimal, a whole number where they are many.
pub(super) fn nats(value: f64) -> String {
    fixed(value, usize::from(value.abs() < 999.5))
}

/// An interval with its unit once.
pub(super) fn interval([low, high]: [f64; 2], unit: &str) -> String {
    if low.is_finite() && high.is_finite() {
        format!("{} to {}", figure(low), quantity(high, unit))
    } else {
        NONE.to_owned()
    }
}

/// What the workers say of an effect.
pub(super) fn descriptor<'a>(subject: &Subject<'a>, id: &str) -> Option<&'a EffectDescriptor> {
    subject.library.iter().find(|effect| effect.id == id)
}

/// What they say of one of its parameters.
pub(super) fn parameter<'a>(
    subject: &Subject<'a>,
    id: &str,
    name: &str,
) -> Option<&'a ParameterDescriptor> {
    let mut parameters = descriptor(subject, id)?.parameters.iter();
    parameters.find(|parameter| parameter.name == name)
}

/// An effect by its title, with the identifier behind it; the identifier alone where the workers do
/// not know it.
pub(super) fn named(subject: &Subject<'_>, id: &str) -> String {
    descriptor(subject, id).map_or_else(
        || id.to_owned(),
        |effect| format!("{} ({id})", lower(&effect.title)),
    )
}

/// A title within a sentence.
fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(letters).collect()
    })
}

/// Items as a sentence lists them.
pub(super) fn listed(items: &[String], last: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.clone(),
        [all @ .., end] => format!("{} {last} {end}", all.join(", ")),
    }
}

/// The sizes of an effect with their intervals, shapes left out.
pub(super) fn sizes(subject: &Subject<'_>, effect: &Estimate) -> String {
    let is_size = |name: &str| {
        parameter(subject, &effect.id, name).is_none_or(|known| known.role == Role::Size)
    };
    let each: Vec<String> = effect
        .parameters
        .iter()
        .filter(|(name, ..)| is_size(name))
        .map(|(name, unit, value, ci95)| {
            format!(
                "{} = {} (95\u{a0}% interval {})",
                name.replace('_', " "),
                quantity(*value, unit),
                interval(*ci95, unit)
            )
        })
        .collect();
    listed(&each, "and")
}

/// The rounds' added effects.
pub(super) fn added(diagnosis: &Diagnosis) -> impl Iterator<Item = &Estimate> + '_ {
    diagnosis.effects.iter().filter(|effect| {
        let mut rounds = diagnosis.rounds.iter();
        rounds.any(|round| round.added.as_ref() == Some(&effect.id))
    })
}

/// The answer in one sentence, without its sizes.
pub(super) fn verdict(subject: &Subject<'_>) -> String {
    let diagnosis = &subject.diagnosed.diagnosis;
    let names = |effects: Vec<&Estimate>| -> Vec<String> {
        let each = effects.iter().map(|effect| named(subject, &effect.id));
        each.collect()
    };
    match diagnosis.verdict {
        Verdict::NothingDetected if diagnosis.limits.is_empty() => {
            "Nothing detected: what the recalibrated simulation leaves of the record is noise; no \
             effect was looked for by name."
                .to_owned()
        }
        Verdict::NothingDetected => {
            "Nothing detected: what the recalibrated simulation leaves of the \
             record is noise, down to the detection limits below."
                .to_owned()
        }
        Verdict::Named => format!(
            "The simulation lacks {}.",
            listed(&names(added(diagnosis).collect()), "and")
        ),
        Verdict::Ambiguous => format!(
            "The simulation lacks {}; this record does not tell which.",
            listed(&choices(subject), "and")
        ),
        Verdict::Unlisted => format!(
            "The simulation lacks something that the library does not have; it acts like {}.",
            diagnosis.generic.as_deref().map_or_else(
                || "a force of unknown form".to_owned(),
                |id| generic(subject, id)
            )
        ),
        Verdict::Unresolved => "Unresolved: this record does not carry a name.".to_owned(),
    }
}

/// What was added, round by round: a name, or the members of a set of which one acts.
fn choices(subject: &Subject<'_>) -> Vec<String> {
    let rounds = &subject.diagnosed.diagnosis.rounds;
    let found = rounds.iter().filter(|round| round.added.is_some());
    let choice = |round: &Round| {
        let members: Vec<String> = round.set.iter().map(|id| named(subject, id)).collect();
        let of = if members.len() > 1 { "one of " } else { "" };
        format!("{of}{}", listed(&members, "or"))
    };
    found.map(choice).collect()
}

/// Effects of the answer with their sizes, and what is only suspected as such: one item each.
pub(super) fn effects(subject: &Subject<'_>) -> Vec<(String, String)> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let label = |id: &str| {
        if diagnosis.verdict == Verdict::Unresolved {
            format!("suspected, not named: {id}")
        } else {
            id.to_owned()
        }
    };
    let each = diagnosis.effects.iter();
    each.map(|effect| (label(&effect.id), sizes(subject, effect)))
        .collect()
}

/// The size of a force without a cause, and by how much it closes the gap on each record.
pub(super) fn force(subject: &Subject<'_>) -> Vec<String> {
    let Some(force) = &subject.diagnosed.diagnosis.force else {
        return Vec::new();
    };
    let phase = force.phase_deg.map_or_else(String::new, |phase| {
        format!(", largest at {} deg of its own turn", figure(phase))
    });
    let mut sentences = vec![format!(
        "The force {}: amplitude {} (95\u{a0}% interval {}){phase}; with every gene fitted again, the \
         record speaks for it by {} nats.",
        force.id,
        quantity(force.amplitude, &force.unit),
        interval(force.interval, &force.unit),
        nats(force.ln_evidence)
    )];
    let rows = force.rows.iter().filter(|row| !row.fitted);
    sentences.extend(rows.map(|row| format!("With that force, {}", closing(subject, row))));
    sentences
}

/// A force without a cause: what it is and where it acts.
pub(super) fn generic(subject: &Subject<'_>, id: &str) -> String {
    descriptor(subject, id).map_or_else(
        || id.to_owned(),
        |force| format!("a {} ({id})", lower(&force.title)),
    )
}

/// How sure the verdict is: one sentence per ground.
pub(super) fn confidence(subject: &Subject<'_>) -> Vec<String> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let mut sentences = Vec::new();
    for effect in added(diagnosis) {
        sentences.push(format!(
            "{}: if it were not there, a test as clear as this one anywhere in the library would have \
             the probability p {}; with every gene fitted again, the record speaks for it by {} nats.",
            effect.id,
            equals(&p_value(effect.p_value)),
            nats(effect.ln_evidence)
        ));
    }
    if let Some((round, rival)) = diagnosis.rejected()
        && let Some(best) = round.refits.first()
    {
        let behind = (best.log_evidence - rival.log_evidence) / (round.phi * round.phi);
        sentences.push(format!(
            "The best rejected rival, {}, lies {} nats behind; 3 are asked for.",
            named(subject, &rival.id),
            nats(behind)
        ));
    }
    sentences.extend(force(subject));
    for row in diagnosis.rows.iter().filter(|row| !row.fitted) {
        if added(diagnosis).next().is_some() {
            sentences.push(closing(subject, row));
        }
    }
    if diagnosis.assumed_noise {
        sentences.push(
            "The noise was assumed, not seen: with one cycle there is no scatter to take it from, so \
             every probability and every limit here is as good as the data sheet."
                .to_owned(),
        );
    }
    sentences
}

/// `= x`, or `< x` as it is.
pub(super) fn equals(p: &str) -> String {
    if p.starts_with('<') {
        p.to_owned()
    } else {
        format!("= {p}")
    }
}

/// What a row's cycles were to the fit.
pub(super) fn role(subject: &Subject<'_>, row: &Row) -> &'static str {
    match (
        row.fitted,
        row.condition == subject.case.objective.condition,
    ) {
        (true, _) => "cycles that were fitted",
        (false, true) => "held-out cycles",
        (false, false) => "another condition, which took no part",
    }
}

/// By how much the gap of a row closed.
fn closing(subject: &Subject<'_>, row: &Row) -> String {
    let closed = row.closed;
    let spread = closed.interval.map_or_else(String::new, |[low, high]| {
        format!(
            " (95\u{a0}% interval {} to {})",
            percent(low),
            percent(high)
        )
    });
    format!(
        "{}, {}: {} of the gap {}{spread}.",
        condition_name(subject.case, row.condition),
        role(subject, row),
        percent(closed.closed.abs()),
        if closed.closed < 0.0 {
            "opened"
        } else {
            "closed"
        }
    )
}

/// What to do next: one sentence each.
pub(super) fn next(subject: &Subject<'_>) -> Vec<String> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let mut steps = Vec::new();
    match diagnosis.verdict {
        Verdict::Named => steps.push(
            "Look at that part of the machine. The entry below, appended to case.toml (or the same \
             command with --add), makes the effect ordinary physics: every simulation has it, and a \
             calibration fits the parameters beside it."
                .to_owned(),
        ),
        Verdict::Ambiguous => {
            steps.push(
                "Look at the members of the set on the machine, or take a record that tells them \
                 apart. The best of them stands in the entry below; its size is right only if its \
                 name is."
                    .to_owned(),
            );
        }
        Verdict::Unlisted => steps.push(
            "Look for the cause where that force acts, and write a law for it: an effect is one file \
             of the simulation. The form of the force is a hint at the law, not the law."
                .to_owned(),
        ),
        Verdict::NothingDetected => steps.push(
            "Believe the recalibrated model as far as the detection limits go; a smaller effect needs \
             more cycles or a quieter chain."
                .to_owned(),
        ),
        Verdict::Unresolved => steps.push(unresolved(diagnosis)),
    }
    if diagnosis.assumed_noise {
        steps.push("Record several cycles: five show the scatter, ten show it well.".to_owned());
    }
    let missing = missing_gauges(subject);
    if !missing.is_empty() && !matches!(diagnosis.verdict, Verdict::NothingDetected) {
        steps.push(format!(
            "Record {} too: the more places a record has, the fewer effects look alike in it.",
            listed(&missing, "and")
        ));
    }
    if subject.records.len() < 2 {
        steps.push(
            "Record a second speed or another load: nothing here was shown on a condition that took \
             no part."
                .to_owned(),
        );
    }
    steps
}

fn unresolved(diagnosis: &Diagnosis) -> String {
    if diagnosis.assumed_noise && diagnosis.before.is_some() {
        "Do not change the machine for a suspect whose noise is only assumed.".to_owned()
    } else if diagnosis.before.is_none() {
        "See that the case simulates at all (`horsehead simulate`) and that its record is complete \
         (`horsehead case check`)."
            .to_owned()
    } else if diagnosis.rounds.is_empty() {
        "Calibrate first (`horsehead calibrate --preset deep`) and diagnose that run: tests mean \
         nothing at a point that is not a minimum."
            .to_owned()
    } else {
        "More cycles, or a record of another speed: the likeliest suspects below say what to look for."
            .to_owned()
    }
}

/// Channels that the machine can have and the record does not.
fn missing_gauges(subject: &Subject<'_>) -> Vec<String> {
    let Some(record) = calibrated(subject) else {
        return Vec::new();
    };
    let wanted = (1..=4).map(Source::Gauge).chain([Source::Torque]);
    wanted
        .filter(|source| !record.channels.contains(source))
        .map(Source::name)
        .collect()
}

/// The record of the calibrated condition.
pub(super) fn calibrated<'a>(subject: &Subject<'a>) -> Option<&'a Record> {
    record(subject, subject.case.objective.condition)
}

/// The record of a condition.
pub(super) fn record<'a>(subject: &Subject<'a>, condition: usize) -> Option<&'a Record> {
    let mut records = subject.records.iter();
    records.find(|record| record.condition == condition && !record.cycles.is_empty())
}

/// How many of the library's sizes would have been seen at their usual size.
pub(super) fn reach(subject: &Subject<'_>) -> Option<String> {
    let limits = &subject.diagnosed.diagnosis.limits;
    let usual = |limit: &&Limit| {
        parameter(subject, &limit.id, &limit.parameter).is_some_and(|p| limit.size <= p.scale)
    };
    let seen = limits.iter().filter(usual).count();
    (!limits.is_empty()).then(|| {
        format!(
            "Of {} sizes in the library, {seen} would have been seen at the size that is usual on \
             machines of this kind.",
            limits.len()
        )
    })
}
