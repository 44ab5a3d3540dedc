//! Report section that shows how far the added effects close the gap to the measurement, on fitted and
//! held-out records, compared with the best rejected rival effect.
use crate::chart::{
    self,
    strip::{self, Strip},
};
use crate::color::BLUE;
use crate::diagnosis::condition_curves::{ConditionCurves, condition_curves};
use crate::diagnosis::subject::DiagnosisInput;
use crate::diagnosis::table as tables;
use crate::document::{Block, Figure, Section, figures};
use crate::number::{percent, unit};
use discrepancy::diagnose::DiscrepancyEstimate;
use maud::html;

pub(super) fn section(subject: &DiagnosisInput<'_>) -> Section {
    let mut blocks = Vec::new();
    let numbers = [tables::gaps(subject), tables::paper(subject)];
    blocks.extend(numbers.into_iter().flatten().map(Block::Table));
    let shown = condition_curves(subject);
    blocks.extend(figures(discrepancy(subject, &shown)));
    blocks.extend(shown.iter().flat_map(curves));
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

/// Draws the smooth discrepancy that the model of the answer still needs on the fitted record, with its band: one
/// figure for each abscissa.
fn discrepancy(subject: &DiagnosisInput<'_>, shown: &[ConditionCurves<'_>]) -> Vec<Figure> {
    let diagnosis = subject.diagnosis();
    let found = diagnosis.remainder.discrepancy.as_ref();
    let (Some(found), Some(shown)) = (found, shown.first()) else {
        return Vec::new();
    };
    let added = diagnosis
        .after
        .as_ref()
        .is_some_and(|fit| !fit.added.is_empty());
    let beside = if added {
        " beside the added effects"
    } else {
        ""
    };
    let title = "The smooth discrepancy that the model still needs";
    let caption = format!(
        "{title}{beside}, with its 95\u{a0}% band: a curve without a cause that takes {} of the gap of the fitted \
         record. Where it leaves zero by more than the band, the next effect is to be looked for.",
        percent(found.share)
    );
    let mut open: Vec<usize> = (0..found.channels.len()).collect();
    let mut drawn = Vec::new();
    while let Some(&first) = open.first() {
        let of_first = &found.channels[first];
        let (own, rest): (Vec<usize>, Vec<usize>) = open
            .into_iter()
            .partition(|&c| found.channels[c].abscissa == of_first.abscissa);
        open = rest;
        let mut channels = shown.record.channels.iter();
        let place = channels.position(|own| own.channel.name == of_first.name);
        if let Some(axis) = place.and_then(|c| shown.axes.get(c)) {
            let strips: Vec<Strip> = own.into_iter().map(|c| band(found, c)).collect();
            let name = format!("discrepancy_{}", drawn.len());
            drawn.push(strip::stack(name, title, caption.clone(), axis, &strips));
        }
    }
    drawn
}

/// Draws the discrepancy of one channel.
fn band(found: &DiscrepancyEstimate, c: usize) -> Strip {
    let channel = &found.channels[c];
    let at = &channel.abscissa.points;
    let (mean, half) = (&found.mean[c], &found.half[c]);
    let band = at.iter().zip(mean).zip(half);
    let title = format!("{} [{}]", channel.title, unit(&channel.unit));
    let line = strip::curve(String::new(), BLUE, at, mean, 1.0);
    Strip {
        band: band
            .map(|((x, y), half)| (*x, y - half, y + half))
            .collect(),
        ..strip::strip(title, 110.0, vec![line])
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
