//! Reading of a case folder in the general form: the case file and every record that it names.
use super::{
    super::{
        document::{Document, DocumentStep},
        effect::{self, CaseEffect},
        error::CaseError,
        loaded::{Loaded, Records},
        names,
        note::Note,
        source::RecordFolder,
    },
    channels::{self, RecordSources},
    conditions,
    file::{CaseFile, ConditionEntry, HeldOutEntry},
    objective, unknowns,
};
use protocol::case::{Case, Offset};
use record::{Curves, Record, Recorded, Stated};
use std::path::Path;

/// Reads a case in the general form, for a model that the coordinator does not know.
///
/// # Errors
/// Returns the first fault found; see [`CaseError`].
pub fn read(source: &RecordFolder<'_>) -> Result<Loaded, CaseError> {
    let RecordFolder {
        folder,
        measured,
        document,
    } = *source;
    let file: CaseFile = document.parse()?;
    let conditions = conditions::read(document, &file.conditions)?;
    let mut unknowns = unknowns::read(document, &file.unknowns)?;
    effect::check(document, &file.effects, &[])?;
    unknowns.extend(file.effects.iter().flat_map(CaseEffect::genes));
    names::check_program_names(
        document,
        "unknowns",
        "unknown",
        &unknowns.iter().map(|own| &*own.name).collect::<Vec<_>>(),
    )?;
    let objective = file.objective.as_ref();
    let place = RecordSources {
        folder,
        replacement_folder: measured,
        calibrated: objective.map(|entry| &entry.condition),
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
        diagnose: file.diagnose,
        effects: file.effects,
    })
}

/// Returns the measured record of a condition with each cycle separately; `None` if nothing was measured.
///
/// # Errors
/// Returns an error if the channels of the condition have different numbers of cycles.
fn cycles(
    document: &Document,
    entries: &[ConditionEntry],
    condition: usize,
    all: &[channels::ReadChannel],
) -> Result<Option<Record>, CaseError> {
    let own = all.iter().enumerate();
    let own = own.filter(|(_, read)| read.channel.condition == condition);
    let measured: Vec<(usize, usize, &channels::ReadChannel)> = own
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
            &[
                DocumentStep::Key("channels"),
                DocumentStep::Index(*at),
                DocumentStep::Key("record"),
            ],
            format!("{} cycles", read.cycles.len()),
            format!(
                "as many as channel `{}` of the same condition has: {}",
                first.channel.name,
                first.cycles.len(),
            ),
            "give the channels of a condition the same cycles",
        ));
    }
    let recorded = |(curve, _, read): &(usize, usize, &channels::ReadChannel)| {
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

/// Splits a channel into its fitted and its held-out part; a channel held out as a whole, or not at all,
/// stays one part.
fn parts(own: Recorded, held_out: HeldOutEntry) -> Vec<Recorded> {
    match held_out {
        HeldOutEntry::Whole(held_out) => vec![Recorded { held_out, ..own }],
        HeldOutEntry::Segment(part) => {
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

/// Returns notes that list the records missing in the folder of `--measured DIR`.
fn not_repeated(measured: Option<&Path>, all: &[channels::ReadChannel]) -> Vec<Note> {
    let Some(folder) = measured else {
        return Vec::new();
    };
    let missing = all.iter().filter_map(|read| read.missing.as_ref());
    let note = |(file, condition): &(String, String)| Note {
        path: folder.to_owned(),
        text: format!(
            "{file} does not exist: condition `{condition}` has no record and is not compared"
        ),
    };
    let mut notes: Vec<Note> = missing.map(note).collect();
    notes.dedup();
    notes
}
