//! Report section with the verdict: one sentence, the effect sizes, the confidence and the recommended next
//! steps.
use crate::chart::{self, BeforeAfter, GapComparison};
use crate::diagnosis::checks::checks;
use crate::diagnosis::condition_curves::condition_curves;
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::words;
use crate::document::{Block, Figure, Section, figures};
use crate::number::unit;
use crate::section::machine_blocks;
use crate::words::{SYNTHETIC, capitalised};

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let diagnosis = subject.diagnosis();
    let mut blocks = vec![Block::Lead(words::verdict(subject))];
    // the first sentence has the reason of an answer in part
    let reason = diagnosis.reason.iter().filter(|_| !diagnosis.is_in_part());
    blocks.extend(reason.map(|reason| Block::Text(format!("The reason: {reason}."))));
    let effects = words::effects(subject);
    if !effects.is_empty() {
        blocks.push(Block::List(effects));
    }
    blocks.extend(figures(best_channel(subject)));
    let heads = ["without the added effects", "with them"];
    blocks.extend(machine_blocks(&checks(subject), heads));
    let numbers = words::gap_numbers(subject);
    if !numbers.is_empty() {
        blocks.push(Block::Facts(numbers));
    }
    let grounds = words::confidence(subject);
    if !grounds.is_empty() {
        blocks.extend([
            Block::Heading("How sure".to_owned(), ""),
            Block::List(grounds),
        ]);
    }
    blocks.extend([
        Block::Heading("What to do next".to_owned(), ""),
        Block::List(words::next(subject)),
    ]);
    if subject.origin.synthetic {
        blocks.push(Block::Text(SYNTHETIC.to_owned()));
    }
    let notes = diagnosis
        .notes
        .iter()
        .chain(&subject.diagnosed.result.notes);
    let notes: Vec<String> = notes.cloned().collect();
    if !notes.is_empty() {
        blocks.push(Block::Warning(notes));
    }
    Section {
        id: "verdict",
        title: "Verdict",
        blocks,
    }
}

/// Draws the scored channel of the calibrated condition whose residual the added effects lower most; without added
/// effects, the one with the largest residual.
fn best_channel(subject: &DiagnosisInput<'_>) -> Option<Figure> {
    let all = condition_curves(subject);
    let shown = all.first()?;
    let scored = shown.record.scored().into_iter();
    let channels = scored.filter_map(|c| shown.channel(c));
    let gain =
        |of: &GapComparison<'_>| of.rms(of.before) - of.after.map_or(0.0, |after| of.rms(after));
    let best = channels.max_by(|a, b| gain(a).total_cmp(&gain(b)))?;
    let shifted = |simulated: &[f64]| -> Vec<f64> {
        let shift = best.shift(simulated);
        simulated.iter().map(|value| value + shift).collect()
    };
    let channel = BeforeAfter {
        title: format!(
            "{}, condition {}",
            capitalised(best.channel),
            best.condition
        ),
        unit: unit(best.unit),
        at: best.at,
        axis: best.axis,
        measured: best.measured,
        spread: best.spread,
        before: shifted(best.before),
        after: best.after.map(shifted),
    };
    let caption = if best.after.is_some() {
        "The channel that shows it best: measured, and simulated by the recalibrated model without and with the added \
         effects; below, measured minus simulated."
    } else {
        "The channel with the largest residual: measured, and simulated by the recalibrated model; below, measured minus \
         simulated."
    };
    chart::before_after(
        &[channel],
        ["without the added effects", "with them"],
        caption.to_owned(),
    )
}
