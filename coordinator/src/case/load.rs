//! From a folder to a [`Case`]: reads `case.toml`, then every file it names.
use super::{
    coefficient::Bodies,
    condition::Source,
    document::Document,
    effect::{self, CaseEffect},
    error::{CaseError, damaged},
    flexible::{self, ReadHead},
    general, genes,
    geometry::Envelope,
    kind,
    loaded::Loaded,
    machine, objective, ranges,
    schema::{CaseFile, FlexibleHead, Records, TwinRopesEntry},
};
use discrepancy::record::Record;
use protocol::{case::Case, pumping_unit::Machine, unit::EFFECT_UNITS};
use std::path::{Path, PathBuf};

/// What a command line may replace in a case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Folder whose cards and records, of the same names, replace those of the case.
    pub measured: Option<PathBuf>,
}

/// Loads a case folder.
///
/// # Errors
/// The first thing that is wrong; see [`CaseError`].
pub fn load(folder: &Path, overrides: &Overrides) -> Result<Case, CaseError> {
    load_with_notes(folder, overrides).map(|loaded| loaded.case)
}

/// Loads a case folder, with remarks and facts.
///
/// # Errors
/// As [`load`].
pub fn load_with_notes(folder: &Path, overrides: &Overrides) -> Result<Loaded, CaseError> {
    let (document, measured) = document(folder, overrides)?;
    if kind::of(&document)? == Machine::KIND {
        return load_machine(folder, overrides).map(|resolved| resolved.loaded);
    }
    general::read(folder, measured, &document)
}

/// The case file, and the folder that replaces the records' own.
fn document<'a>(
    folder: &Path,
    overrides: &'a Overrides,
) -> Result<(Document, Option<&'a Path>), CaseError> {
    let measured = overrides.measured.as_deref();
    if let Some(absent) = measured.filter(|path| !path.is_dir()) {
        return Err(damaged(
            absent,
            "there is no such folder; --measured names it",
            "give the folder that holds the records of the test",
        ));
    }
    let document = Document::read(
        &folder.join("case.toml"),
        "the description of the case; `horsehead case new` writes a template",
    )?;
    Ok((document, measured))
}

/// As [`load_with_notes`], with the machine.
pub(super) fn load_machine(folder: &Path, overrides: &Overrides) -> Result<Resolved, CaseError> {
    let mut resolved = resolve(folder, overrides)?;
    match resolved.head.stale.take() {
        Some(stale) => Err(stale),
        None => Ok(resolved),
    }
}

/// A case with what its file and the head's files say of the flexible head.
pub(super) struct Resolved {
    pub(super) loaded: Loaded,
    /// Where beam and ropes move.
    pub(super) envelope: Envelope,
    /// That of the case.
    pub(super) machine: Machine,
    /// Tables of another mesh are no error yet.
    pub(super) head: ReadHead,
    pub(super) flexible: FlexibleHead,
    pub(super) twins: Option<TwinRopesEntry>,
}

/// Reads a case and all its files.
///
/// # Errors
/// As [`load`], but for tables of another mesh.
pub(super) fn resolve(folder: &Path, overrides: &Overrides) -> Result<Resolved, CaseError> {
    let (document, measured) = document(folder, overrides)?;
    let file: CaseFile = document.parse()?;
    ranges::check(&document, &file)?;
    let envelope = machine::check(&document, &file)?;
    let head = flexible::read(folder, &document, &file)?;
    machine::check_arc(&document, &file, &head.head.arc_deg, &envelope)?;
    let objective = objective::read(&document, file.objective.as_ref(), &file.conditions)?;
    effect::check(&document, &file.effects, &EFFECT_UNITS)?;
    let source = Source {
        folder,
        measured,
        document: &document,
        file: &file,
    };
    let (mut notes, mut records) = (Vec::new(), Vec::new());
    let (mut cycles, mut channels) = (Vec::new(), Vec::new());
    let (mut conditions, mut working) = (Vec::new(), Vec::new());
    for read in source.conditions()? {
        conditions.push(read.condition);
        working.push(read.working);
        channels.extend(read.channels);
        records.push(read.facts);
        cycles.extend(read.cycles.map(Record::held_out_last));
        notes.extend(read.notes);
    }
    let mut unknowns = genes::declared(&document, &file.genes, &Bodies::of(&file))?;
    unknowns.extend(file.effects.iter().flat_map(CaseEffect::genes));
    let machine = Machine {
        gravity_m_s2: file.gravity_m_s2,
        beam: file.beam,
        crank: file.crank,
        rod: file.rod,
        suspension: file.suspension,
        ropes: file.ropes,
        contact: file.contact,
        front_head: file.front_head,
        back_head: file.back_head,
        modal_head: head.head.clone(),
        twin_ropes: head.twins.clone(),
        conditions: working,
        run: file.run,
    };
    let case = Case {
        name: file.name,
        model: machine.settings().map_err(|error| {
            damaged(
                &document.path,
                format!("the machine does not fit into a message: {error}"),
                "reduce the head with fewer modes or stations",
            )
        })?,
        effects: file.effects.iter().map(CaseEffect::setting).collect(),
        effect_units: file.effects.iter().map(CaseEffect::units).collect(),
        unknowns,
        conditions,
        channels,
        objective,
    };
    let loaded = Loaded {
        synthetic: file.records == Records::Synthetic && measured.is_none(),
        case,
        notes,
        records,
        cycles,
        effects: file.effects,
    };
    Ok(Resolved {
        loaded,
        envelope,
        machine,
        head,
        flexible: file.flexible_head,
        twins: file.twin_ropes,
    })
}
