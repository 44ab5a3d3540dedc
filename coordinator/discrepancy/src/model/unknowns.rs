//! The model that is fitted: the case's genes, and the effects that have been added to it.
//!
//! A point is a vector of unknowns: genes by their coordinates in the space, then the parameters of
//! each added effect in units of their physical scale, from their absent value. What an effect does is
//! the workers' business; here it is a name with numbers.
use crate::model::parameter::{setting, variable};
use protocol::announce::EffectDescriptor;
use protocol::{
    job::{Individual, Reply, SimulateSpec},
    pumping_unit::Discretisation,
};
use search::least_squares::{Prior, Variable};
use search::space::Space;

/// Prior standard deviation of a gene (coordinate): the recommended values of a manual are rarely off
/// by more than a few of these decades. Parameters of the case's effects are hardly held by it: the
/// whole interval that they are searched in is two long.
const GENE_DEVIATION: f64 = 1.5;
/// First difference step of a gene (coordinate).
const GENE_STEP: f64 = 0.02;

/// A case with added effects.
#[derive(Clone, Debug)]
pub struct Model {
    /// The genes.
    pub space: Space,
    /// Added effects, in the order in which they were added.
    pub added: Vec<EffectDescriptor>,
}

impl Model {
    /// The case alone.
    pub const fn plain(space: Space) -> Self {
        Self {
            space,
            added: Vec::new(),
        }
    }

    /// Where the unknowns of an added effect begin.
    pub fn first_of(&self, position: usize) -> usize {
        let before = self.added.iter().take(position);
        self.space.dimension() + before.map(|e| e.parameters.len()).sum::<usize>()
    }

    /// The unknowns, starting at `x`; what is beyond its length starts at its typical value for a
    /// shape, absent for a size.
    pub fn variables(&self, x: &[f64]) -> Vec<Variable> {
        let genes = self.space.axes().iter().map(|axis| {
            let interval = axis.interval();
            Variable {
                start: 0.0,
                lower: interval.from,
                upper: interval.to,
                step: GENE_STEP,
                prior: Some(Prior {
                    mean: 0.0,
                    deviation: GENE_DEVIATION,
                }),
            }
        });
        let effects = self
            .added
            .iter()
            .flat_map(|e| e.parameters.iter().map(variable));
        let mut all: Vec<Variable> = genes.chain(effects).collect();
        for (variable, x) in all.iter_mut().zip(x) {
            variable.start = *x;
        }
        all
    }

    /// Gene values of a point, in declared units.
    pub fn genes(&self, x: &[f64]) -> Vec<f64> {
        self.space.values(&x[..self.space.dimension()])
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
    /// With one more effect at scaled values of its parameters.
    #[must_use]
    pub fn with(mut self, effect: &EffectDescriptor, own: &[f64]) -> Self {
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
        self
    }

    /// The job that simulates it under a condition.
    pub fn experiment(&self, condition: usize, discretisation: Discretisation) -> SimulateSpec {
        let Self { model, x } = self;
        let effects = model.added.iter().enumerate().map(|(position, effect)| {
            let first = model.first_of(position);
            setting(effect, &x[first..first + effect.parameters.len()])
        });
        SimulateSpec {
            individual: Individual {
                condition,
                genes: model.genes(x),
                effects: effects.collect(),
            },
            discretisation,
            reply: Reply::Channels,
        }
    }
}
