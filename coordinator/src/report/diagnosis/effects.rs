//! What was found, as entries of a model file.
use super::Subject;
use discrepancy::diagnose::Estimate;
use std::fmt::Write as _;

/// `[[effects]]` tables of the added effects, with intervals and where they come from; nothing if no
/// effect was added. Members of an ambiguity set beside the best are named in its provenance.
pub fn effects_toml(subject: &Subject<'_>) -> Option<String> {
    let diagnosis = &subject.diagnosed.diagnosis;
    let mut text = String::new();
    for (number, round) in (1..).zip(&diagnosis.rounds) {
        let Some(id) = &round.added else { continue };
        let Some(found) = diagnosis.effects.iter().find(|effect| effect.id == *id) else {
            continue;
        };
        entry(&mut text, subject, found, (number, &round.set));
    }
    (!text.is_empty()).then_some(text)
}

fn entry(
    text: &mut String,
    subject: &Subject<'_>,
    found: &Estimate,
    (round, set): (usize, &[String]),
) {
    let verdict = if set.len() > 1 { "ambiguous" } else { "named" };
    let set: Vec<String> = set.iter().map(|id| format!("\"{id}\"")).collect();
    // a String takes everything that is written to it
    let _infallible = write!(
        text,
        "# {}\n[[effects]]\nid = \"{}\"\n",
        found.title, found.id
    );
    for (name, unit, value, [low, high]) in &found.parameters {
        let _infallible = writeln!(
            text,
            "parameters.{name} = {{ value = {value:e}, unit = \"{unit}\", ci95 = [{low:e}, {high:e}] }}"
        );
    }
    let _infallible = writeln!(
        text,
        "provenance = {{ case = \"{}\", round = {round}, verdict = \"{verdict}\", set = [{}], ln_evidence = {:.1} }}\n",
        subject.provenance.case_hash,
        set.join(", "),
        found.ln_evidence
    );
}
