//! The answer as plain text, for a terminal.
use super::Subject;
use discrepancy::diagnose::{Diagnosis, Estimate};
use discrepancy::stage::show::Row;
use discrepancy::verdict::Verdict;
use std::fmt::Write as _;

/// The whole answer.
pub fn text(subject: &Subject<'_>) -> String {
    let diagnosis = &subject.diagnosed.diagnosis;
    let mut text = headline(diagnosis);
    if let Some(reason) = &diagnosis.reason {
        push(&mut text, reason);
    }
    if diagnosis.assumed_noise {
        push(
            &mut text,
            "The noise was assumed, not seen: record several cycles.",
        );
    }
    for effect in &diagnosis.effects {
        push(&mut text, &sizes(effect));
    }
    gaps(&mut text, subject, "gap", &diagnosis.rows);
    if let Some((rival, rows)) = &diagnosis.rival {
        gaps(
            &mut text,
            subject,
            &format!("best rejected rival, {rival}"),
            rows,
        );
    }
    suspects(&mut text, diagnosis);
    for note in &diagnosis.notes {
        push(&mut text, &format!("note: {note}"));
    }
    costs(&mut text, subject);
    text
}

fn push(text: &mut String, line: &str) {
    text.push_str(line);
    text.push('\n');
}

/// The verdict in a sentence.
fn headline(diagnosis: &Diagnosis) -> String {
    let names: Vec<&str> = diagnosis.effects.iter().map(|e| e.id.as_str()).collect();
    match diagnosis.verdict {
        Verdict::NothingDetected => {
            "NOTHING DETECTED: what remains is noise, down to the detection limits below.\n"
                .to_owned()
        }
        Verdict::Named => format!("NAMED: {}\n", names.join(" and ")),
        Verdict::Ambiguous => format!("AMBIGUOUS: one of {}\n", names.join(", ")),
        Verdict::Unlisted => format!(
            "UNLISTED: nothing in the library, but it acts like {}\n",
            diagnosis
                .generic
                .as_deref()
                .unwrap_or("a force of unknown form")
        ),
        Verdict::Unresolved => "UNRESOLVED\n".to_owned(),
    }
}

fn sizes(effect: &Estimate) -> String {
    let each = effect
        .parameters
        .iter()
        .map(|(name, unit, value, [low, high])| {
            format!("{name} = {value:.4} {unit} [{low:.4}, {high:.4}]")
        });
    format!(
        "  {}: {}; p = {:.1e}, {:.1} nats",
        effect.id,
        each.collect::<Vec<_>>().join(", "),
        effect.p_value,
        effect.ln_evidence
    )
}

fn gaps(text: &mut String, subject: &Subject<'_>, title: &str, rows: &[Row]) {
    for row in rows {
        let condition = &subject.case.conditions[row.condition].name;
        let role = match (
            row.fitted,
            row.condition == subject.case.objective.condition,
        ) {
            (true, _) => "cycles that were fitted",
            (false, true) => "held-out cycles",
            (false, false) => "took no part",
        };
        let closed = row.closed;
        let interval = closed.interval.map_or(String::new(), |[low, high]| {
            format!(" [{:.0}, {:.0}]", 100.0 * low, 100.0 * high)
        });
        push(
            text,
            &format!(
                "{title}, {condition} ({role}): {:.3} % -> {:.3} % of the variance, {:.0} % closed{interval}",
                100.0 * closed.before,
                100.0 * closed.after,
                100.0 * closed.closed
            ),
        );
    }
}

/// The first round's suspects, the most likely first.
fn suspects(text: &mut String, diagnosis: &Diagnosis) {
    for (number, round) in (1..).zip(&diagnosis.rounds) {
        push(
            text,
            &format!(
                "round {number}: misfit {:.2}, family p = {:.1e}",
                round.phi, round.p_value
            ),
        );
        for refit in &round.refits {
            let gain = (refit.log_evidence - round.null_evidence) / (round.phi * round.phi);
            push(text, &format!("  {:<26} {gain:9.1} nats", refit.id));
        }
        if let Some(reason) = &round.reason {
            push(text, &format!("  {reason}"));
        }
    }
}

fn costs(text: &mut String, subject: &Subject<'_>) {
    let mut total = 0;
    for (stage, account) in &subject.diagnosed.accounts {
        total += account.experiments;
        let _infallible = writeln!(
            text,
            "{:<20} {:6} simulations, {:3} failed, {:7.1} s",
            stage.name(),
            account.experiments,
            account.failed,
            account.wall.as_secs_f64()
        );
    }
    push(
        text,
        &format!("{total} simulations in {:.0} s", subject.wall_s),
    );
}
