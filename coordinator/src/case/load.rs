//! From a folder to a [`Case`]: reads `case.toml`, then every file it names.
use super::{
    card,
    coefficient::Bodies,
    document::{Document, Step, nearest},
    effect::{self, CaseEffect},
    error::{CaseError, damaged},
    flexible::{self, ReadHead},
    genes,
    geometry::Envelope,
    machine,
    note::Note,
    record::{self, Expected, RecordFacts},
    schema::{CaseFile, ConditionEntry, FlexibleHead, ObjectiveEntry, Records, TwinRopesEntry},
};
use discrepancy::record::Record;
use protocol::case::{Case, Condition, Objective, Quantity, Smoothing};
use std::path::{Path, PathBuf};

/// What a command line may replace in a case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Overrides {
    /// Folder whose cards and records, of the same names, replace those of the case.
    pub measured: Option<PathBuf>,
}

/// A case with what was found on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The case.
    pub case: Case,
    /// Remarks that are no errors.
    pub notes: Vec<Note>,
    /// Facts about each condition's record, in the order of the conditions.
    pub records: Vec<Option<RecordFacts>>,
    /// Every cycle of each record by itself, for a diagnosis; only conditions that have a record.
    pub cycles: Vec<Record>,
    /// Whether the case says that its gauge records were computed; never of replaced ones.
    pub synthetic: bool,
    /// Effects as the file states them, with intervals and provenance.
    pub effects: Vec<CaseEffect>,
    /// Where beam and ropes move.
    pub envelope: Envelope,
}

impl Loaded {
    /// The case as it was when effects were found in it: without those whose provenance names it, by its
    /// content hash, as their dataset, and without their genes.
    #[must_use]
    pub fn without_found_in(mut self, dataset: &str) -> Self {
        let found = |effect: &CaseEffect| {
            let provenance = effect.provenance.as_ref();
            provenance.and_then(|p| p.dataset.as_deref()) == Some(dataset)
        };
        self.effects.retain(|effect| !found(effect));
        self.case.effects = self.effects.iter().map(CaseEffect::setting).collect();
        self.case.effect_units = self.effects.iter().map(CaseEffect::units).collect();
        let left = &self.case.effects;
        self.case.genes.retain(|gene| match &gene.quantity {
            Quantity::Coefficient { .. } => true,
            Quantity::Effect { id, .. } => left.iter().any(|effect| effect.id == *id),
        });
        self
    }
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
    let (loaded, head, _) = resolve(folder, overrides)?;
    match head.stale {
        Some(stale) => Err(stale),
        None => Ok(loaded),
    }
}

/// What the case file says of the flexible head, and of the ropes on it.
type HeadEntries = (FlexibleHead, Option<TwinRopesEntry>);

/// A case with the head's files; tables of another mesh are no error yet.
pub(super) fn resolve(
    folder: &Path,
    overrides: &Overrides,
) -> Result<(Loaded, ReadHead, HeadEntries), CaseError> {
    if let Some(measured) = overrides.measured.as_deref().filter(|path| !path.is_dir()) {
        return Err(damaged(
            measured,
            "there is no such folder; --measured names it",
            "give the folder that holds the load cards and gauge records of the test",
        ));
    }
    let document = Document::read(
        &folder.join("case.toml"),
        "the description of the case; `horsehead case new` writes a template",
    )?;
    let file: CaseFile = document.parse()?;
    let envelope = machine::check(&document, &file)?;
    let read = flexible::read(folder, &document, &file)?;
    machine::check_arc(&document, &file, &read.head.arc_deg, &envelope)?;
    check_names(&document, &file.conditions)?;
    let objective = objective(&document, &file.objective, &file.conditions)?;
    effect::check(&document, &file.effects)?;
    let mut notes = Vec::new();
    let mut records = Vec::new();
    let mut cycles = Vec::new();
    let mut conditions = Vec::new();
    for index in 0..file.conditions.len() {
        let source = Source {
            folder,
            overrides,
            document: &document,
            file: &file,
        };
        let read = source.condition(index)?;
        conditions.push(read.condition);
        records.push(read.facts);
        cycles.extend(read.cycles);
        notes.extend(read.notes);
    }
    let bodies = Bodies::of(&file);
    let mut genes = genes::declared(&document, file.genes, &bodies)?;
    genes.extend(file.effects.iter().flat_map(CaseEffect::genes));
    let case = Case {
        name: file.name,
        gravity_m_s2: file.gravity_m_s2,
        beam: file.beam,
        crank: file.crank,
        rod: file.rod,
        suspension: file.suspension,
        ropes: file.ropes,
        contact: file.contact,
        front_head: file.front_head,
        back_head: file.back_head,
        modal_head: read.head.clone(),
        twin_ropes: read.twins.clone(),
        effects: file.effects.iter().map(CaseEffect::setting).collect(),
        effect_units: file.effects.iter().map(CaseEffect::units).collect(),
        genes,
        conditions,
        objective,
        run: file.run,
    };
    let loaded = Loaded {
        synthetic: file.records == Records::Synthetic && overrides.measured.is_none(),
        case,
        notes,
        records,
        cycles,
        effects: file.effects,
        envelope,
    };
    Ok((loaded, read, (file.flexible_head, file.twin_ropes)))
}

/// Where conditions come from.
struct Source<'a> {
    folder: &'a Path,
    overrides: &'a Overrides,
    document: &'a Document,
    file: &'a CaseFile,
}

/// A condition with what its record gave.
struct ReadCondition {
    condition: Condition,
    facts: Option<RecordFacts>,
    cycles: Option<Record>,
    notes: Vec<Note>,
}

impl Source<'_> {
    /// Reads one condition with its card and record.
    fn condition(&self, index: usize) -> Result<ReadCondition, CaseError> {
        let Some(entry) = self.file.conditions.get(index) else {
            return Err(damaged(&self.document.path, "no such condition", "add it"));
        };
        let way = |key| [Step::Key("conditions"), Step::Index(index), Step::Key(key)];
        check_condition(self.document, entry, way)?;
        let role = format!(
            "the load card of condition `{}` in {}",
            entry.name,
            self.document.path.display()
        );
        let not_repeated = self.not_repeated(entry);
        let card_file = if not_repeated.is_some() && !self.place(&entry.card_file).exists() {
            self.folder.join(&entry.card_file)
        } else {
            self.place(&entry.card_file)
        };
        let card = card::read(&card_file, entry.smoothing, &role)?;
        let highest = card.load_n.len() / 2;
        if let Smoothing::Harmonics(kept) = entry.smoothing
            && kept as usize > highest
        {
            return Err(self.document.field(
                &way("smoothing"),
                format!("{{ harmonics = {kept} }}"),
                format!(
                    "1 to {highest}: a card of {} points has no more",
                    card.load_n.len()
                ),
                "keep fewer harmonics, or use smoothing = \"none\"",
            ));
        }
        let expected = Expected {
            index,
            condition: &entry.name,
            speed_rpm: entry.speed_rpm,
            case_file: &self.document.path,
            step_deg: self.file.run.output_step_deg,
            sense: self.file.crank.sense,
        };
        let record_file = entry.record_file.as_ref();
        let read = record_file
            .filter(|_| not_repeated.is_none())
            .map(|name| record::read(&self.place(name), &expected))
            .transpose()?;
        let (record, facts, cycles, notes) = match read {
            Some(read) => (
                Some(read.record),
                Some(read.facts),
                Some(read.cycles),
                read.notes,
            ),
            None => (None, None, None, not_repeated.into_iter().collect()),
        };
        let condition = Condition {
            name: entry.name.clone(),
            speed_rpm: entry.speed_rpm,
            counterweight_moment_n_m: entry.counterweight_moment_n_m,
            card,
            record,
        };
        Ok(ReadCondition {
            condition,
            facts,
            cycles,
            notes,
        })
    }

    /// A remark if the test in `--measured DIR` did not repeat a condition: it has no record then, and
    /// the case's card. That of the objective must be there.
    fn not_repeated(&self, entry: &ConditionEntry) -> Option<Note> {
        let measured = self.overrides.measured.as_ref()?;
        let record = self.place(entry.record_file.as_ref()?);
        let needed = entry.name == self.file.objective.condition;
        (!needed && !record.exists()).then(|| Note {
            path: measured.clone(),
            text: format!(
                "{} is not there: condition `{}` was not measured, and nothing is compared with it",
                record.file_name().unwrap_or_default().display(),
                entry.name
            ),
        })
    }

    /// Where a card or record is read from: `--measured DIR` replaces the folder, not the name.
    fn place(&self, named: &Path) -> PathBuf {
        match (&self.overrides.measured, named.file_name()) {
            (Some(measured), Some(name)) => measured.join(name),
            _ => self.folder.join(named),
        }
    }
}

/// Conditions exist and have names of their own.
fn check_names(document: &Document, conditions: &[ConditionEntry]) -> Result<(), CaseError> {
    if conditions.is_empty() {
        return Err(document.field(
            &[Step::Key("conditions")],
            "[]",
            "at least one condition",
            "add a [[conditions]] table with name, speed and load card",
        ));
    }
    for (index, condition) in conditions.iter().enumerate() {
        let way = [
            Step::Key("conditions"),
            Step::Index(index),
            Step::Key("name"),
        ];
        let name = &condition.name;
        let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.');
        if name.is_empty() || !name.chars().all(plain) {
            return Err(document.field(
                &way,
                format!("\"{name}\""),
                "a short name of letters, digits, `-`, `_` and `.`",
                "the name is typed on command lines and becomes part of file names, as `5rpm`",
            ));
        }
        let earlier = conditions.iter().take(index);
        if earlier.clone().any(|other| other.name == *name) {
            return Err(document.field(
                &way,
                format!("\"{name}\""),
                "a name that no other condition has",
                "duplicate condition: rename or remove one of the two",
            ));
        }
    }
    Ok(())
}

/// Ranges of a condition's own numbers.
fn check_condition<'a>(
    document: &Document,
    entry: &ConditionEntry,
    way: impl Fn(&'static str) -> [Step<'a>; 3],
) -> Result<(), CaseError> {
    if !(0.1..=60.0).contains(&entry.speed_rpm) {
        return Err(document.field(
            &way("speed_rpm"),
            entry.speed_rpm,
            "0.1 to 60 revolutions per minute",
            "give the crank speed, not the motor's",
        ));
    }
    if !(0.0..=1.0e7).contains(&entry.counterweight_moment_n_m) {
        return Err(document.field(
            &way("counterweight_moment_n_m"),
            entry.counterweight_moment_n_m,
            "0 to 1e7 N m",
            "give weight times radius of the counterweights in N m",
        ));
    }
    Ok(())
}

/// The objective, with its condition by index.
fn objective(
    document: &Document,
    entry: &ObjectiveEntry,
    conditions: &[ConditionEntry],
) -> Result<Objective, CaseError> {
    let names = conditions.iter().map(|condition| condition.name.as_str());
    let list: Vec<&str> = names.clone().collect();
    let way = |key| [Step::Key("objective"), Step::Key(key)];
    let Some(condition) = names.clone().position(|name| name == entry.condition) else {
        return Err(document.field(
            &way("condition"),
            format!("\"{}\"", entry.condition),
            format!("the name of a condition: {}", list.join(", ")),
            &nearest(&entry.condition, names)
                .map_or("name one of the conditions".to_owned(), |near| {
                    format!("did you mean `{near}`?")
                }),
        ));
    };
    if conditions
        .get(condition)
        .is_some_and(|entry| entry.record_file.is_none())
    {
        return Err(document.field(
            &way("condition"),
            format!("\"{}\"", entry.condition),
            "a condition with a record_file",
            "there is nothing to compare with: add record_file to the condition, or take another",
        ));
    }
    if entry.gauges.is_empty() {
        return Err(document.field(
            &way("gauges"),
            "[]",
            "at least one gauge",
            "write gauges = [{ gauge = 1, weight = 1.0 }]",
        ));
    }
    for (index, part) in entry.gauges.iter().enumerate() {
        let way = |key| {
            [
                Step::Key("objective"),
                Step::Key("gauges"),
                Step::Index(index),
                Step::Key(key),
            ]
        };
        let twice = entry
            .gauges
            .iter()
            .take(index)
            .any(|other| other.gauge == part.gauge);
        if !(1..=4).contains(&part.gauge) || twice {
            return Err(document.field(
                &way("gauge"),
                part.gauge,
                "1 to 4, each once",
                "gauges are numbered as in the record's columns stress_1_mpa .. stress_4_mpa",
            ));
        }
        if !(part.weight > 0.0 && part.weight <= 1.0e6) {
            return Err(document.field(
                &way("weight"),
                part.weight,
                "above 0, at most 1e6",
                "leave a gauge out that is not to count",
            ));
        }
    }
    Ok(Objective {
        condition,
        gauges: entry
            .gauges
            .iter()
            .map(|part| (part.gauge, part.weight))
            .collect(),
        offset: entry.offset,
    })
}
