//! Report section that shows how far the added effects close the gap to the measurement, on fitted and
//! held-out records, compared with the best rejected rival effect.
use crate::chart;
use crate::diagnosis::condition_curves::{ConditionCurves, condition_curves};
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::table as tables;
use crate::document::{Block, Section, figures};
use maud::html;

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let mut blocks = Vec::new();
    let numbers = [tables::gaps(subject), tables::paper(subject)];
    blocks.extend(numbers.into_iter().flatten().map(Block::Table));
    blocks.extend(condition_curves(subject).iter().flat_map(curves));
    let rounds = &subject.diagnosis().rounds;
    let added = rounds.iter().any(|round| round.added.is_some());
    if !added && !blocks.is_empty() {
        let same =
            "Nothing was added: before and after are the same model, shown for what it leaves.";
        blocks.insert(0, Block::Text(same.to_owned()));
    }
    Section {
        id: "show",
        title: "Validation: the gap before and after",
        blocks,
    }
}

/// Draws the curves of one condition: the scored channels, and the other channels in a collapsed block.
fn curves(shown: &ConditionCurves<'_>) -> Vec<Block> {
    let heading = html! { h3 { "Condition " (shown.condition) } };
    let mut blocks = vec![Block::Markup(heading)];
    let (scored, others): (Vec<usize>, Vec<usize>) = shown
        .order()
        .into_iter()
        .partition(|&c| shown.record.channels[c].scored);
    let draw = |channels: Vec<usize>| {
        let drawn = channels.into_iter();
        figures(drawn.filter_map(|c| chart::closing(&shown.channel(c)?)))
    };
    blocks.extend(draw(scored));
    let others = draw(others);
    if !others.is_empty() {
        blocks.push(Block::Folded("Other channels", others));
    }
    blocks
}
