//! Model that is fitted: the unknowns of the case, nuisance parameters and added effects.
//!
//! A point is a vector: unknowns of the case by their coordinates in the space, nuisance parameters of the
//! record in standard deviations, then the parameters of each added effect in units of their physical scale,
//! from their absent value. Only the workers know how an effect acts; here it is a name with parameter
//! values.
use crate::model::inactive_unknowns::InactiveUnknowns;
use crate::model::nuisance_parameter::{NuisanceParameter, apply_gains, effects};
use crate::model::parameter::{setting, variable};
use crate::thresholds::WITHIN;
use protocol::announce::EffectDescriptor;
use protocol::case::EffectSetting;
use protocol::job::{Individual, Numerics, Reply, SimulateSpec};
use record::{Curves, Record};
use search::least_squares::{Prior, Variable};
use search::space::Space;

/// Prior standard deviation of an unknown for which the case states none (coordinate): the recommended values
/// of a manual are rarely off by more than a few of these decades. An unknown on a linear scale is hardly
/// constrained by it, since its whole interval has the length two.
const USUAL_DEVIATION: f64 = 1.5;
/// Initial finite-difference step of an unknown of the case, in its coordinate of the search space.
const STEP: f64 = 0.02;
/// Longest step of a fit in an unknown of the case (coordinate of the search space): a twentieth of it
/// already shifts resonances.
const LONGEST: f64 = 0.7;

/// Model that is fitted: a case's unknowns, nuisance parameters of the record and added effects.
#[derive(Clone, Debug)]
pub struct FittedModel {
    /// Search space of the case's unknowns.
    pub space: Space,
    /// Switched-off unknowns of the case, each tested as a candidate effect.
    pub off: Vec<InactiveUnknowns>,
    /// Nuisance parameters of the record; those that an added effect stands for are ignored.
    pub nuisances: Vec<NuisanceParameter>,
    /// Effects added to the model, in the order in which they were added.
    pub added: Vec<EffectDescriptor>,
    /// Default prior of those unknowns for which the case states only bounds.
    pub unstated: DefaultPrior,
    /// Index of an unknown of the case that is held at its start value; `None` if all are free.
    pub fixed_unknown: Option<usize>,
}

/// Prior of an unknown for which the case states only bounds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum DefaultPrior {
    /// Normal prior about the recommended value, with a standard deviation of 1.5 coordinates: a recommended
    /// value is rarely off by more than a few decades.
    #[default]
    Recommended,
    /// Weak prior about the middle of the interval: at a bound it adds no more than a quarter of a unit to
    /// `-2 ln L`.
    Bounds,
}

impl FittedModel {
    /// Creates the model of the case without nuisance parameters and effects.
    pub const fn plain(space: Space) -> Self {
        Self {
            space,
            off: Vec::new(),
            nuisances: Vec::new(),
            added: Vec::new(),
            unstated: DefaultPrior::Recommended,
            fixed_unknown: None,
        }
    }

    /// Iterates over the nuisance parameters that no added effect replaces, in the order of their unknowns.
    pub fn active_nuisances(&self) -> impl Iterator<Item = &NuisanceParameter> {
        let replaced =
            |one: &&NuisanceParameter| self.added.iter().any(|effect| one.is(&effect.id));
        self.nuisances.iter().filter(move |one| !replaced(one))
    }

    /// Iterates over the nuisance parameters that no added effect replaces, each with the index of its
    /// unknown.
    pub(crate) fn indexed_nuisances(&self) -> impl Iterator<Item = (usize, &NuisanceParameter)> {
        let first = self.space.dimension();
        self.active_nuisances()
            .enumerate()
            .map(move |(k, one)| (first + k, one))
    }

    /// Iterates over the nuisance parameters that no added effect replaces, each with its value at a point.
    pub(crate) fn nuisance_values(
        &self,
        x: &[f64],
    ) -> impl Iterator<Item = (&NuisanceParameter, f64)> {
        self.indexed_nuisances().map(|(k, one)| (one, x[k]))
    }

    /// Returns the index, in a point's vector, of the first parameter of the added effect at `position`.
    pub fn first_of(&self, position: usize) -> usize {
        let before = self.added.iter().take(position);
        let nuisances = self.active_nuisances().count();
        self.space.dimension() + nuisances + before.map(|e| e.parameters.len()).sum::<usize>()
    }

    /// Returns the unknowns as variables that start at `x`. Unknowns beyond the length of `x` start at their
    /// default: zero for nuisance parameters and sizes, the typical value for a shape.
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
                    DefaultPrior::Recommended => Prior {
                        mean: 0.0,
                        deviation: USUAL_DEVIATION,
                    },
                    DefaultPrior::Bounds => Prior {
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
        let nuisances = self.active_nuisances().map(NuisanceParameter::variable);
        let mut all: Vec<Variable> = own.chain(nuisances).chain(effects).collect();
        for (variable, x) in all.iter_mut().zip(x) {
            variable.start = *x;
        }
        if let Some(held) = self.fixed_unknown.and_then(|k| all.get_mut(k)) {
            held.lower = held.start;
            held.upper = held.start;
        }
        all
    }

    /// Returns the values of all unknowns of the case at the point `x`, in the units that the case declares.
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

    /// Iterates over the added effects with their settings at a point, each with the unknowns of the case
    /// that it stands for, if any.
    fn settings(
        &self,
        x: &[f64],
    ) -> impl Iterator<Item = (Option<&InactiveUnknowns>, EffectSetting)> {
        let added = self.added.iter().enumerate();
        added.map(move |(position, added)| {
            let first = self.first_of(position);
            let own = &x[first..first + added.parameters.len()];
            let off = self.off.iter().find(|off| off.candidate.id == added.id);
            (off, setting(added, own))
        })
    }
}

/// Fitted model at given values of its unknowns.
#[derive(Clone, Debug)]
pub struct Point {
    /// Model to which the values belong.
    pub model: FittedModel,
    /// Values of the model's unknowns, one per unknown.
    pub x: Vec<f64>,
}

impl Point {
    /// Adds an effect to the model, at scaled values of its parameters. The value of a nuisance parameter
    /// that the effect replaces is added to that of the effect's parameter.
    #[must_use]
    pub fn with(mut self, effect: &EffectDescriptor, own: &[f64]) -> Self {
        let mut own = own.to_vec();
        let placed = self
            .model
            .indexed_nuisances()
            .filter(|(_, one)| one.is(&effect.id));
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

    /// Removes the effect at a position with its unknowns; the nuisance parameters that it replaced return
    /// with value zero.
    #[must_use]
    pub fn without(mut self, position: usize) -> Self {
        let first = self.model.first_of(position);
        let effect = self.model.added.remove(position);
        self.x.drain(first..first + effect.parameters.len());
        // what it was as a nuisance is one again
        let placed = self.model.indexed_nuisances();
        let again = placed.filter(|(_, one)| one.is(&effect.id));
        for place in again.map(|(place, _)| place).collect::<Vec<usize>>() {
            self.x.insert(place, 0.0);
        }
        self
    }

    /// Replaces the values of the case's unknowns.
    #[must_use]
    pub(crate) fn with_genes(mut self, genes: &[f64]) -> Self {
        self.x[..genes.len()].copy_from_slice(genes);
        self
    }

    /// Limits the nuisance parameters to [`WITHIN`] standard deviations.
    #[must_use]
    pub(crate) fn with_held_instruments(mut self) -> Self {
        for one in &mut self.model.nuisances {
            one.farthest = WITHIN;
        }
        self.map_instruments(|x| x.clamp(-WITHIN, WITHIN))
    }

    /// Removes the limit of the nuisance parameters, so that only their priors hold them.
    #[must_use]
    pub(crate) fn with_released_instruments(mut self) -> Self {
        let nuisances = self.model.nuisances.iter_mut();
        nuisances.for_each(NuisanceParameter::release);
        self
    }

    /// Sets every nuisance parameter to its absent value.
    #[must_use]
    pub(crate) fn with_exact_instruments(self) -> Self {
        self.map_instruments(|_| 0.0)
    }

    fn map_instruments(mut self, change: impl Fn(f64) -> f64) -> Self {
        let first = self.model.space.dimension();
        let count = self.model.active_nuisances().count();
        for x in &mut self.x[first..first + count] {
            *x = change(*x);
        }
        self
    }

    /// Multiplies simulated curves by the instrument gains of the record's channels at this point.
    pub(crate) fn apply_gains(&self, record: &Record, curves: &mut Curves) {
        apply_gains(self.model.nuisance_values(&self.x), record, curves);
    }

    /// Returns the machine at the point under a condition: without the errors of its instruments.
    pub(crate) fn machine(&self, condition: usize) -> Individual {
        let Self { model, x } = self;
        let added = model.settings(x).filter(|(off, _)| off.is_none());
        Individual {
            effects: added.map(|(_, setting)| setting).collect(),
            ..Individual::new(condition, model.genes(x))
        }
    }

    /// Creates the job that simulates the point under a condition.
    pub fn experiment(&self, condition: usize, numerics: &Numerics) -> SimulateSpec {
        let Self { model, x } = self;
        let never_exact = effects(model.nuisance_values(x)).into_iter();
        let never_exact = never_exact.map(|(effect, own)| setting(effect, &own));
        let mut individual = self.machine(condition);
        individual.effects.splice(..0, never_exact);
        SimulateSpec {
            individual,
            numerics: numerics.clone(),
            reply: Reply::Channels,
            columns: Vec::new(),
        }
    }
}
