//! What is diagnosed, and by which thresholds.
use crate::model::off::Off;
use crate::record::measured::Record;
use crate::thresholds::Thresholds;
use protocol::announce::EffectDescriptor;
use protocol::case::Unknown;
use protocol::job::Numerics;
use search::space::Space;

/// A case with its records, and what may be suspected.
#[derive(Clone, Debug)]
pub struct Inputs {
    /// The case's unknowns and their bounds.
    pub space: Space,
    /// Names of the case's conditions, in its order.
    pub conditions: Vec<String>,
    /// All unknowns of the case, of which those that are off are suspected.
    pub unknowns: Vec<Unknown>,
    /// Records, the calibrated condition's first.
    pub records: Vec<Record>,
    /// What the workers can simulate.
    pub library: Vec<EffectDescriptor>,
    /// A calibrated point (coordinates of the space), if there is one.
    pub start: Option<Vec<f64>>,
    /// Numerics of all experiments but that of the numerical check.
    pub usual: Numerics,
    /// Finer ones, for the numerical check: the finest, then what it is made of, one thing at a
    /// time, for where the finest does not complete.
    pub finer: Vec<Numerics>,
    /// Preset of the search that finds the way into the valley where nothing is known.
    pub entrance: &'static str,
    /// Seed of that search.
    pub seed: u64,
    /// How it is decided.
    pub thresholds: Thresholds,
    /// Whether a laboratory that could differentiate is not to: every derivative is a difference.
    pub differences: bool,
}

impl Inputs {
    /// The effects of the library, and the case's unknowns that are off, that nobody has put aside.
    pub(crate) fn considered(&self) -> impl Iterator<Item = EffectDescriptor> {
        let without = &self.thresholds.without;
        let off = Off::of(&self.unknowns).into_iter().map(|off| off.suspect);
        let all = self.library.iter().cloned().chain(off);
        all.filter(|suspect| !without.contains(&suspect.id))
    }

    /// A condition by its name, in words; by its place where it has none.
    pub(crate) fn condition(&self, place: usize) -> String {
        let name = self.conditions.get(place);
        name.map_or_else(
            || format!("condition {}", place + 1),
            |name| format!("condition {name}"),
        )
    }

    /// Records of the other conditions that are not held out.
    pub(crate) fn others(&self) -> impl Iterator<Item = &Record> {
        self.records
            .iter()
            .skip(1)
            .filter(|record| !record.held_out)
    }
}
