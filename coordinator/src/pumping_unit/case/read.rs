//! From a case file of a pumping unit to a [`Case`]: the file, then every file that it names.
use super::{
    coefficient::Bodies,
    condition,
    flexible::{self, ReadHead},
    genes,
    geometry::Envelope,
    machine, objective, ranges,
    record::RecordFacts,
    schema::{CaseFile, FlexibleHead, TwinRopesEntry},
};
use crate::case::{
    effect::{self, CaseEffect},
    error::{CaseError, damaged},
    loaded::{Loaded, Records},
    note::Note,
    source::Source,
};
use discrepancy::record::Record;
use protocol::{
    case::Case,
    pumping_unit::{EFFECT_UNITS, Machine},
};

/// Reads a case with its machine.
///
/// # Errors
/// The first thing that is wrong; see [`CaseError`].
pub(in crate::pumping_unit) fn read(source: &Source<'_>) -> Result<Resolved, CaseError> {
    let mut resolved = resolve(source)?;
    match resolved.head.stale.take() {
        Some(stale) => Err(stale),
        None => Ok(resolved),
    }
}

/// A case with what its file and the head's files say of the flexible head.
pub(in crate::pumping_unit) struct Resolved {
    pub(in crate::pumping_unit) loaded: Loaded,
    /// Facts about each condition's record, in the order of the conditions.
    pub(super) facts: Vec<Option<RecordFacts>>,
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
/// As [`read`], but for tables of another mesh.
pub(super) fn resolve(source: &Source<'_>) -> Result<Resolved, CaseError> {
    let Source {
        folder,
        measured,
        document,
    } = *source;
    let file: CaseFile = document.parse()?;
    ranges::check(document, &file)?;
    let envelope = machine::check(document, &file)?;
    let head = flexible::read(folder, document, &file)?;
    machine::check_arc(document, &file, &head.head.arc_deg, &envelope)?;
    let mut objective = objective::read(document, file.objective.as_ref(), &file.conditions)?;
    effect::check(document, &file.effects, &EFFECT_UNITS)?;
    let (mut notes, mut facts) = (Vec::new(), Vec::new());
    let (mut cycles, mut channels) = (Vec::new(), Vec::new());
    let (mut conditions, mut working) = (Vec::new(), Vec::new());
    for read in condition::read_all(source, &file)? {
        conditions.push(read.condition);
        working.push(read.working);
        let stated = file.objective.as_ref();
        channels.extend(objective::with_offset(stated, read.channels));
        facts.push(read.facts);
        cycles.extend(read.cycles.map(Record::held_out_last));
        notes.extend(read.notes);
    }
    let said = objective::over_recorded(&mut objective, &channels);
    notes.extend(said.map(|text| Note {
        path: document.path.clone(),
        text,
    }));
    let mut unknowns = genes::declared(document, &file.genes, &Bodies::of(&file))?;
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
        cycles,
        effects: file.effects,
    };
    Ok(Resolved {
        loaded,
        facts,
        envelope,
        machine,
        head,
        flexible: file.flexible_head,
        twins: file.twin_ropes,
    })
}
