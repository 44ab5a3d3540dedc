//! The model that is fitted: the case's unknowns, and the effects that have been added to it.
//!
//! A point is a vector: unknowns of the case by their coordinates in the space, nuisances of the record by
//! standard deviations, then the parameters of each added effect in units of their physical scale, from
//! their absent value. What an effect does is the workers' business; here it is a name with numbers.
use crate::model::off::Off;
use crate::model::parameter::{setting, variable};
use crate::model::tolerated::{Tolerated, effects, read};
use crate::record::measured::{Curves, Record};
use protocol::announce::EffectDescriptor;
use protocol::case::EffectSetting;
use protocol::job::{Individual, Numerics, Reply, SimulateSpec};
use search::least_squares::{Prior, Variable};
use search::space::Space;

/// Prior standard deviation of an unknown of which the case states none (coordinate): the recommended
/// values of a manual are rarely off by more than a few of these decades. What is on a linear scale is
/// hardly held by it: the whole interval that it is searched in is two long.
const USUAL_DEVIATION: f64 = 1.5;
/// First difference step of an unknown of the case (coordinate).
const STEP: f64 = 0.02;
/// Longest step of one (coordinate): resonances move with a twentieth of it.
const LONGEST: f64 = 0.7;

/// A case with added effects.
#[derive(Clone, Debug)]
pub struct Model {
    /// Those of the case that are searched.
    pub space: Space,
    /// Those of the case that are off.
    pub off: Vec<Off>,
    /// What is never exact about the record; of these, what an added effect is does not count.
    pub nuisances: Vec<Tolerated>,
    /// Added effects, in the order in which they were added.
    pub added: Vec<EffectDescriptor>,
    /// What holds an unknown of which the case says nothing but its bounds.
    pub unstated: Unstated,
    /// An unknown that stays where a point has it, by its place.
    pub held: Option<usize>,
}

/// What holds an unknown of which the case says nothing but its bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Unstated {
    /// That a recommended value is rarely off by more than a few decades.
    #[default]
    Recommended,
    /// Next to nothing: at a bound, no more than a quarter of a unit of `-2 ln L` is its own.
    Bounds,
}

impl Model {
    /// The case alone.
    pub const fn plain(space: Space) -> Self {
        Self {
            space,
            off: Vec::new(),
            nuisances: Vec::new(),
            added: Vec::new(),
            unstated: Unstated::Recommended,
            held: None,
        }
    }

    /// Nuisances that no added effect is, in the order of their unknowns.
    pub fn standing(&self) -> impl Iterator<Item = &Tolerated> {
        let replaced = |one: &&Tolerated| self.added.iter().any(|effect| one.is(&effect.id));
        self.nuisances.iter().filter(move |one| !replaced(one))
    }

    /// Those with the place of their unknown.
    pub(crate) fn placed(&self) -> impl Iterator<Item = (usize, &Tolerated)> {
        let first = self.space.dimension();
        self.standing()
            .enumerate()
            .map(move |(k, one)| (first + k, one))
    }

    /// Those with their values at a point.
    pub(crate) fn valued(&self, x: &[f64]) -> impl Iterator<Item = (&Tolerated, f64)> {
        self.placed().map(|(k, one)| (one, x[k]))
    }

    /// Where the unknowns of an added effect begin.
    pub fn first_of(&self, position: usize) -> usize {
        let before = self.added.iter().take(position);
        let nuisances = self.standing().count();
        self.space.dimension() + nuisances + before.map(|e| e.parameters.len()).sum::<usize>()
    }

    /// The unknowns, starting at `x`; what is beyond its length starts at its typical value for a
    /// shape, absent for a size.
    pub fn variables(&self, x: &[f64]) -> Vec<Variable> {
        let own = self.space.axes().iter().map(|axis| {
            let interval = axis.interval();
            let prior = axis.unknown.prior.map(|prior| Prior {
                mean: axis.coordinate(prior.value),
                deviation: prior.deviation,
            });
            Variable {
                start: 0.0,
                lower: interval.from,
                upper: interval.to,
                step: axis.unknown.step.unwrap_or(STEP),
                longest: LONGEST,
                prior: prior.or(Some(match self.unstated {
                    Unstated::Recommended => Prior {
                        mean: 0.0,
                        deviation: USUAL_DEVIATION,
                    },
                    Unstated::Bounds => Prior {
                        mean: f64::midpoint(interval.from, interval.to),
                        deviation: interval.length(),
                    },
                })),
            }
        });
        let effects = self
            .added
            .iter()
            .flat_map(|e| e.parameters.iter().map(variable));
        let nuisances = self.standing().map(Tolerated::variable);
        let mut all: Vec<Variable> = own.chain(nuisances).chain(effects).collect();
        for (variable, x) in all.iter_mut().zip(x) {
            variable.start = *x;
        }
        if let Some(held) = self.held.and_then(|k| all.get_mut(k)) {
            held.lower = held.start;
            held.upper = held.start;
        }
        all
    }

    /// Values of all unknowns of the case at a point, in declared units.
    pub fn genes(&self, x: &[f64]) -> Vec<f64> {
        let mut values = self.space.values(&x[..self.space.dimension()]);
        for (off, setting) in self.settings(x) {
            let positions = off.into_iter().flat_map(|off| &off.positions);
            for (position, (_, value)) in positions.zip(&setting.parameters) {
                values[*position] = *value;
            }
        }
        values
    }

    /// What was added, at a point; with the unknown that it is, if it is one.
    fn settings(&self, x: &[f64]) -> impl Iterator<Item = (Option<&Off>, EffectSetting)> {
        let added = self.added.iter().enumerate();
        added.map(move |(position, added)| {
            let first = self.first_of(position);
            let own = &x[first..first + added.parameters.len()];
            let off = self.off.iter().find(|off| off.suspect.id == added.id);
            (off, setting(added, own))
        })
    }
}

/// A model at values of its unknowns.
#[derive(Clone, Debug)]
pub struct Point {
    /// The model.
    pub model: Model,
    /// One value per unknown.
    pub x: Vec<f64>,
}

impl Point {
    /// With one more effect at scaled values of its parameters, beside what it is as a nuisance.
    #[must_use]
    pub fn with(mut self, effect: &EffectDescriptor, own: &[f64]) -> Self {
        let mut own = own.to_vec();
        let placed = self.model.placed().filter(|(_, one)| one.is(&effect.id));
        let mut replaced: Vec<usize> = Vec::new();
        for (place, one) in placed {
            if let Some((_, k)) = one.effect() {
                own[k] += one.in_scales(self.x[place]);
            }
            replaced.push(place);
        }
        for place in replaced.into_iter().rev() {
            self.x.remove(place);
        }
        self.model.added.push(effect.clone());
        self.x.extend(own);
        self
    }

    /// Without the effect at a position and its unknowns.
    #[must_use]
    pub fn without(mut self, position: usize) -> Self {
        let first = self.model.first_of(position);
        let effect = self.model.added.remove(position);
        self.x.drain(first..first + effect.parameters.len());
        // what it was as a nuisance is one again
        let placed = self.model.placed();
        let again = placed.filter(|(_, one)| one.is(&effect.id));
        for place in again.map(|(place, _)| place).collect::<Vec<usize>>() {
            self.x.insert(place, 0.0);
        }
        self
    }

    /// What a record's channels read where they would show these curves.
    pub(crate) fn read(&self, record: &Record, curves: &mut Curves) {
        read(self.model.valued(&self.x), record, curves);
    }

    /// The job that simulates it under a condition.
    pub fn experiment(&self, condition: usize, numerics: &Numerics) -> SimulateSpec {
        let Self { model, x } = self;
        let added = model.settings(x).filter(|(off, _)| off.is_none());
        let never_exact = effects(model.valued(x)).into_iter();
        let never_exact = never_exact.map(|(effect, own)| setting(effect, &own));
        let mut individual = Individual::new(condition, model.genes(x));
        individual.effects = never_exact
            .chain(added.map(|(_, setting)| setting))
            .collect();
        SimulateSpec {
            individual,
            numerics: numerics.clone(),
            reply: Reply::Channels,
            columns: Vec::new(),
        }
    }
}
