//! The model that is fitted: the case's genes, and the effects that have been added to it.
//!
//! A point is a vector of unknowns: genes by their coordinates in the space, then the parameters of
//! each added effect in units of their physical scale, from their absent value. What an effect does is
//! the workers' business; here it is a name with numbers.
use protocol::announce::{EffectDescriptor, ParameterDescriptor, Role, Sign};
use protocol::case::EffectSetting;
use protocol::job::{ObserveSpec, Refinement};
use search::least_squares::{Prior, Variable};
use search::space::Space;

/// Prior standard deviation of a gene (coordinate): the recommended values of a manual are rarely off
/// by more than a few of these decades. Parameters of the case's effects are hardly held by it: the
/// whole interval that they are searched in is two long.
const GENE_DEVIATION: f64 = 1.5;
/// First difference step of a gene (coordinate).
const GENE_STEP: f64 = 0.02;
/// Prior standard deviation of a size, in units of its scale.
const SIZE_DEVIATION: f64 = 2.0;

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

    /// With one more effect.
    #[must_use]
    pub fn with(&self, effect: &EffectDescriptor) -> Self {
        let mut more = self.clone();
        more.added.push(effect.clone());
        more
    }

    /// Without the effect at a position.
    #[must_use]
    pub fn without(&self, position: usize) -> Self {
        let mut fewer = self.clone();
        fewer.added.remove(position);
        fewer
    }

    /// Number of unknowns.
    pub fn dimension(&self) -> usize {
        self.space.dimension() + self.added.iter().map(|e| e.parameters.len()).sum::<usize>()
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

    /// The job that simulates a point under a condition.
    pub fn experiment(&self, x: &[f64], condition: usize, refinement: Refinement) -> ObserveSpec {
        let effects = self.added.iter().enumerate().map(|(position, effect)| {
            let first = self.first_of(position);
            setting(effect, &x[first..first + effect.parameters.len()])
        });
        ObserveSpec {
            condition,
            genes: self.genes(x),
            effects: effects.collect(),
            refinement,
        }
    }

    /// Gene values of a point, in declared units.
    pub fn genes(&self, x: &[f64]) -> Vec<f64> {
        self.space.values(&x[..self.space.dimension()])
    }
}

/// A parameter as an unknown, in units of its scale from its absent value.
fn variable(parameter: &ParameterDescriptor) -> Variable {
    let scaled = |value: f64| (value - parameter.absent) / parameter.scale;
    let (lower, upper) = (scaled(parameter.lower), scaled(parameter.upper));
    let lower = match parameter.sign {
        Sign::Positive if parameter.role == Role::Size => lower.max(0.0),
        Sign::Positive | Sign::Either => lower,
    };
    let (start, deviation) = match parameter.role {
        Role::Size => (0.0, SIZE_DEVIATION),
        Role::Shape => (scaled(parameter.typical), 0.5 * (upper - lower)),
    };
    Variable {
        start,
        lower,
        upper,
        step: 0.05,
        prior: Some(Prior {
            mean: start,
            deviation,
        }),
    }
}

/// An effect with the values of a scaled vector; one entry per parameter.
pub fn setting(effect: &EffectDescriptor, scaled: &[f64]) -> EffectSetting {
    let value = |(p, u): (&ParameterDescriptor, &f64)| {
        let value = (p.absent + u * p.scale).clamp(p.lower, p.upper);
        (p.name.clone(), value)
    };
    EffectSetting {
        id: effect.id.clone(),
        parameters: effect.parameters.iter().zip(scaled).map(value).collect(),
    }
}

/// Values of an effect that is not there: sizes absent, shapes typical; scaled.
pub fn absent(effect: &EffectDescriptor) -> Vec<f64> {
    effect
        .parameters
        .iter()
        .map(|p| variable(p).start)
        .collect()
}

/// Positions of an effect's sizes among its parameters.
pub fn sizes(effect: &EffectDescriptor) -> Vec<usize> {
    positions(effect, Role::Size)
}

/// Positions of an effect's shapes among its parameters.
pub fn shapes(effect: &EffectDescriptor) -> Vec<usize> {
    positions(effect, Role::Shape)
}

fn positions(effect: &EffectDescriptor, role: Role) -> Vec<usize> {
    let parameters = effect.parameters.iter().enumerate();
    parameters
        .filter(|(_, p)| p.role == role)
        .map(|(k, _)| k)
        .collect()
}

/// Bounds of a scaled parameter.
pub fn bounds(parameter: &ParameterDescriptor) -> [f64; 2] {
    let variable = variable(parameter);
    [variable.lower, variable.upper]
}
