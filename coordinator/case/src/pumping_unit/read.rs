//! Reading of a pumping unit's case: the case file, then every file that it names, as a [`Case`].
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
use crate::{
    effect::{self, CaseEffect},
    error::{CaseError, Faults, damaged},
    loaded::{Loaded, Records},
    source::RecordFolder,
};
use protocol::{
    case::{Case, Objective, Unknown},
    pumping_unit::{EFFECT_UNITS, Machine},
};
use record::Record;

/// Reads a case with its machine.
///
/// # Errors
/// Returns all faults found; see [`CaseError`].
pub(super) fn read(source: &RecordFolder<'_>) -> Result<Resolved, CaseError> {
    resolve(source, StaleTables::Refused)
}

/// Treatment of tables of the head that are missing although they follow from its mesh, or were computed from
/// another one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StaleTables {
    /// Tables that are out of date are an error.
    Refused,
    /// Tables that are out of date are accepted, because they are to be computed again.
    Accepted,
}

/// Case with its machine and the data of its flexible head.
pub(super) struct Resolved {
    pub loaded: Loaded,
    /// Facts about each condition's record, in the order of the conditions.
    pub(super) facts: Vec<Option<RecordFacts>>,
    /// Range of motion of beam and ropes over one crank turn.
    pub(super) envelope: Envelope,
    pub(super) machine: Machine,
    /// Flexible head of the machine.
    pub(super) head: ReadHead,
    pub(super) flexible: FlexibleHead,
    pub(super) twins: Option<TwinRopesEntry>,
}

/// Reads a case and all its files.
///
/// # Errors
/// As [`read`], except for tables of the head that are out of date and accepted.
pub(super) fn resolve(
    source: &RecordFolder<'_>,
    stale: StaleTables,
) -> Result<Resolved, CaseError> {
    let RecordFolder {
        measured, document, ..
    } = *source;
    let file: CaseFile = document.parse()?;
    let Parts {
        envelope,
        head,
        mut objective,
        mut unknowns,
        conditions: read,
    } = parts(source, &file, stale)?;
    let stated = file.objective.as_ref();
    unknowns.extend(file.effects.iter().flat_map(CaseEffect::genes));
    let (mut notes, mut facts) = (Vec::from_iter(head.notes.clone()), Vec::new());
    let (mut cycles, mut channels) = (Vec::new(), Vec::new());
    let (mut conditions, mut working) = (Vec::new(), Vec::new());
    for read in read {
        conditions.push(read.condition);
        working.push(read.working);
        channels.extend(objective::with_offset(stated, read.channels));
        facts.push(read.facts);
        cycles.extend(read.cycles.map(Record::held_out_last));
        notes.extend(read.notes);
    }
    let names: Vec<&str> = file.conditions.iter().map(|own| &*own.name).collect();
    let recorded = (&names[..], &channels[..], &facts[..]);
    notes.extend(objective::restrict_to_recorded(
        document,
        stated,
        &mut objective,
        recorded,
    )?);
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
        diagnose: file.diagnose,
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

/// Parts of a pumping-unit case, read independently of each other so that all errors are reported at once.
struct Parts {
    envelope: Envelope,
    head: ReadHead,
    objective: Objective,
    unknowns: Vec<Unknown>,
    conditions: Vec<condition::ReadCondition>,
}

/// Reads every part of a case.
///
/// # Errors
/// Returns the faults of all parts.
fn parts(
    source: &RecordFolder<'_>,
    file: &CaseFile,
    stale: StaleTables,
) -> Result<Parts, CaseError> {
    let RecordFolder {
        folder, document, ..
    } = *source;
    let mut faults = Faults::default();
    // geometry of numbers that cannot be right would be faults that are none
    let ranged = faults.take(ranges::check(document, file));
    let envelope = ranged.and_then(|()| faults.take(machine::check(document, file)));
    let mut head = faults.take(flexible::read(folder, document, file));
    if stale == StaleTables::Refused {
        let stale = head.as_mut().and_then(|head| head.stale.take());
        faults.take(stale.map_or(Ok(()), Err));
    }
    if let (Some(envelope), Some(head)) = (&envelope, &head) {
        let arc = &head.head.arc_deg;
        faults.take(machine::check_contact_on_arc(document, file, arc, envelope));
        faults.take(machine::check_inertia(document, file, head.head.mass_kg));
    }
    let stated = file.objective.as_ref();
    let objective = faults.take(objective::read(document, stated, &file.conditions));
    faults.take(effect::check(document, &file.effects, &EFFECT_UNITS));
    let unknowns = faults.take(genes::declared(document, &file.genes, &Bodies::of(file)));
    let read = faults.take(condition::read_all(source, file));
    faults.end()?;
    let (Some(envelope), Some(head), Some(objective), Some(unknowns), Some(conditions)) =
        (envelope, head, objective, unknowns, read)
    else {
        return Err(damaged(
            &document.path,
            "it cannot be read",
            "copy it again",
        ));
    };
    Ok(Parts {
        envelope,
        head,
        objective,
        unknowns,
        conditions,
    })
}
