//! From a folder to a case: the file, then every record that it names.
use super::{
    super::{
        document::{Document, Step},
        effect::{self, CaseEffect},
        error::CaseError,
        loaded::{Loaded, Records},
        note::Note,
        source::Source,
    },
    channels::{self, Place},
    conditions,
    file::{CaseFile, ConditionEntry, HeldOut},
    objective, unknowns,
};
use discrepancy::record::{Curves, Record, Recorded, Stated};
use protocol::case::{Case, Offset};
use std::path::Path;

/// Reads a case of a model that nobody here knows.
///
/// # Errors
/// The first thing that is wrong; see [`CaseError`].
pub fn read(source: &Source<'_>) -> Result<Loaded, CaseError> {
    let Source {
        folder,
        measured,
        document,
    } = *source;
    let file: CaseFile = document.parse()?;
    let conditions = conditions::read(document, &file.conditions)?;
    let mut unknowns = unknowns::read(document, &file.unknowns)?;
    effect::check(document, &file.effects, &[])?;
    unknowns.extend(file.effects.iter().flat_map(CaseEffect::genes));
    let objective = file.objective.as_ref();
    let place = Place {
        folder,
        measured,
        calibrated: objective.map_or(&[], |entry| entry.condition.all()),
        offset: objective.map_or(Offset::Free, |entry| entry.offset),
    };
    let read = channels::read(document, &file.channels, &file.conditions, &place)?;
    let objective = objective::read(document, objective, &file.conditions, &read)?;
    let cycles = (0..conditions.len()).map(|at| cycles(document, &file.conditions, at, &read));
    let cycles: Vec<Option<Record>> = cycles.collect::<Result<_, _>>()?;
    let notes = not_repeated(measured, &read);
    Ok(Loaded {
        synthetic: file.records == Records::Synthetic && measured.is_none(),
        case: Case {
            name: file.name,
            model: conditions::settings(&file.model, &file.conditions),
            effects: file.effects.iter().map(CaseEffect::setting).collect(),
            effect_units: file.effects.iter().map(CaseEffect::units).collect(),
            unknowns,
            conditions,
            channels: read.into_iter().map(|read| read.channel).collect(),
            objective,
        },
        notes,
        cycles: cycles
            .into_iter()
            .flatten()
            .map(Record::held_out_last)
            .collect(),
        effects: file.effects,
    })
}

/// The cycles of a condition, each by itself; none where nothing was measured.
///
/// # Errors
/// Channels of one condition that have another number of cycles.
fn cycles(
    document: &Document,
    entries: &[ConditionEntry],
    condition: usize,
    all: &[channels::Read],
) -> Result<Option<Record>, CaseError> {
    let own = all.iter().enumerate();
    let own = own.filter(|(_, read)| read.channel.condition == condition);
    let measured: Vec<(usize, usize, &channels::Read)> = own
        .enumerate()
        .map(|(curve, (at, read))| (curve, at, read))
        .filter(|(_, _, read)| !read.cycles.is_empty())
        .collect();
    let Some((_, _, first)) = measured.first() else {
        return Ok(None);
    };
    for (_, at, read) in &measured {
        if read.cycles.len() == first.cycles.len() {
            continue;
        }
        return Err(document.field(
            &[Step::Key("channels"), Step::Index(*at), Step::Key("record")],
            format!("{} cycles", read.cycles.len()),
            format!(
                "as many as channel `{}` of the same condition has: {}",
                first.channel.name,
                first.cycles.len(),
            ),
            "give the channels of a condition the same cycles",
        ));
    }
    let recorded = |(curve, _, read): &(usize, usize, &channels::Read)| {
        let own = Recorded {
            correlation: read.correlation,
            model_error: read.model_error,
            ..Recorded::new(*curve, &read.channel)
        };
        parts(own, read.held_out)
    };
    let channels: Vec<Vec<Recorded>> = measured.iter().map(recorded).collect();
    let cycle = |at: usize| -> Curves {
        let both = measured.iter().zip(&channels);
        let parts = both.flat_map(|((_, _, read), own)| {
            let whole = &read.cycles[at];
            own.iter().filter_map(|part| part.pick(whole))
        });
        parts.collect()
    };
    Ok(Some(Record {
        condition,
        cycles: (0..first.cycles.len()).map(cycle).collect(),
        held_out: entries[condition].held_out,
        stated: Stated::default(),
        channels: channels.into_iter().flatten().collect(),
    }))
}

/// A channel as it is fitted and as it is held out.
fn parts(own: Recorded, held_out: HeldOut) -> Vec<Recorded> {
    match held_out {
        HeldOut::Whole(held_out) => vec![Recorded { held_out, ..own }],
        HeldOut::Segment(part) => {
            let points = own.channel.abscissa.points.iter().enumerate();
            let (inside, outside): (Vec<_>, Vec<_>) =
                points.partition(|(_, x)| (part.from..=part.to).contains(*x));
            let places = |of: Vec<(usize, &f64)>| of.into_iter().map(|(k, _)| k).collect();
            vec![
                own.part(places(outside), false),
                own.part(places(inside), true),
            ]
        }
    }
}

/// Remarks on records that `--measured DIR` does not repeat.
fn not_repeated(measured: Option<&Path>, all: &[channels::Read]) -> Vec<Note> {
    let Some(folder) = measured else {
        return Vec::new();
    };
    let missing = all.iter().filter_map(|read| read.missing.as_ref());
    let note = |(file, condition): &(String, String)| Note {
        path: folder.to_owned(),
        text: format!(
            "{file} is not there: condition `{condition}` was not measured, and nothing is compared \
             with it"
        ),
    };
    let mut notes: Vec<Note> = missing.map(note).collect();
    notes.dedup();
    notes
}
