//! Inputs of a diagnosis, with its thresholds.
use crate::model::off::Off;
use crate::record::measured::Record;
use crate::thresholds::Thresholds;
use protocol::announce::EffectDescriptor;
use protocol::case::Unknown;
use protocol::job::Numerics;
use search::space::Space;

/// Case with its records and candidate effects.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// Unknowns of the case with their bounds.
    pub space: Space,
    /// Names of the case's conditions, in its order.
    pub conditions: Vec<String>,
    /// All unknowns of the case; those that are switched off are candidate effects.
    pub unknowns: Vec<Unknown>,
    /// Records, the calibrated condition's first.
    pub records: Vec<Record>,
    /// Effects that the workers can simulate.
    pub library: Vec<EffectDescriptor>,
    /// A calibrated point (coordinates of the space), if there is one.
    pub start: Option<Vec<f64>>,
    /// Numerics of all experiments except the numerical check.
    pub usual: Numerics,
    /// Finer numerics for the numerical check: first the finest, then its refinements one at a time, for use
    /// where the finest does not complete.
    pub finer: Vec<Numerics>,
    /// Preset of the global search for the narrow minimum if there is no start.
    pub entrance: &'static str,
    /// Seed of the global search.
    pub seed: u64,
    /// Thresholds of all decisions.
    pub thresholds: Thresholds,
    /// Whether derivatives are computed by finite differences even if the laboratory can differentiate.
    pub differences: bool,
}

impl Inputs {
    /// Returns the effects of the library and the unknowns that are switched off, except those excluded by
    /// the thresholds.
    pub(crate) fn considered(&self) -> impl Iterator<Item = EffectDescriptor> {
        let without = &self.thresholds.without;
        let off = Off::of(&self.unknowns).into_iter().map(|off| off.suspect);
        let all = self.library.iter().cloned().chain(off);
        all.filter(|suspect| !without.contains(&suspect.id))
    }

    /// Returns the name of a condition with the word "condition", or its number where it has no name.
    pub(crate) fn condition(&self, place: usize) -> String {
        let name = self.conditions.get(place);
        name.map_or_else(
            || format!("condition {}", place + 1),
            |name| format!("condition {name}"),
        )
    }

    /// Returns the records of the other conditions that are not held out.
    pub(crate) fn others(&self) -> impl Iterator<Item = &Record> {
        self.records
            .iter()
            .skip(1)
            .filter(|record| !record.held_out)
    }
}
