//! Linearised model of a case, which answers the requests of a diagnosis.
use anyhow::{Context as _, anyhow, ensure};
use discrepancy::laboratory::{Laboratory, Stage};
use discrepancy::model::sizes;
use protocol::announce::{EffectDescriptor, ParameterDescriptor};
use protocol::case::{Case, EffectSetting};
use protocol::job::{
    Column, Counters, Derivative, Failure, Individual, MAX_COLUMNS, Numerics, Observation, Per,
    Reply, SimulateSpec, Verdict, to_single_precision,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::convert::Infallible;
use worker::simulator::{Model, Simulators, simulator_of};

/// Curves of a case at one point under every condition, and their derivatives there.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct LinearModel {
    /// Name of the case.
    pub case: String,
    /// Names of the unknowns, and their values at the point.
    pub genes: Vec<(String, f64)>,
    /// Effects of which every size has a derivative.
    pub library: Vec<EffectDescriptor>,
    /// Value at which each size of the library vanishes, by the name of its derivative.
    absent: BTreeMap<String, f64>,
    conditions: Vec<Linearization>,
}

/// Curves and derivatives under one condition.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Linearization {
    /// Curves with each numerical setting, the usual one first.
    curves: Vec<(Numerics, Vec<Vec<f64>>)>,
    /// Derivatives by unknown or `EFFECT.PARAMETER`.
    columns: BTreeMap<String, (Per, Vec<Vec<f32>>)>,
}

impl LinearModel {
    /// Linearises a case about the start values of its unknowns, with the effects that its simulator knows and the
    /// case lacks; `numerics` as in [`Self::new`].
    ///
    /// # Errors
    /// No simulator for the case, and those of [`Self::new`].
    pub fn of_case(
        case: &Case,
        simulators: Simulators,
        numerics: &[Numerics],
    ) -> anyhow::Result<Self> {
        let refused = |failure: Failure| anyhow!("{failure:?}");
        let simulator = simulator_of(simulators, case).map_err(refused)?;
        let prepared = simulator.prepare(case).map_err(refused)?;
        let mut library = simulator.effects();
        library.retain(|effect| case.effects.iter().all(|own| own.id != effect.id));
        let genes: Vec<f64> = case.unknowns.iter().map(|own| own.start).collect();
        Self::new((&*prepared, case), &genes, library, numerics)
    }

    /// Linearises a case about values of its unknowns. `library` are the effects that a diagnosis may add,
    /// `numerics` the settings with which it simulates, the usual one first. An effect that cannot be simulated
    /// is left out.
    ///
    /// # Errors
    /// A point or an unknown that cannot be simulated.
    pub fn new(
        (model, case): (&dyn Model, &Case),
        genes: &[f64],
        library: Vec<EffectDescriptor>,
        numerics: &[Numerics],
    ) -> anyhow::Result<Self> {
        ensure!(
            genes.len() == case.unknowns.len(),
            "one value per unknown is needed"
        );
        let names = case.unknowns.iter().map(|own| own.name.clone());
        let genes: Vec<(String, f64)> = names.zip(genes.iter().copied()).collect();
        let amounts = library.iter().flat_map(Size::all);
        let mut own = Self {
            case: case.name.clone(),
            absent: amounts.map(|own| (own.column(), own.of.absent)).collect(),
            genes,
            library,
            conditions: Vec::new(),
        };
        for condition in 0..case.conditions.len() {
            let linear = own.linearized(model, condition, numerics)?;
            own.conditions.push(linear);
        }
        let known = |effect: &EffectDescriptor| {
            let mut all = own.conditions.iter();
            all.all(|own| Size::all(effect).all(|size| own.columns.contains_key(&size.column())))
        };
        let library = std::mem::take(&mut own.library);
        let kept = library.into_iter().filter(known).collect();
        own.library = kept;
        Ok(own)
    }

    fn linearized(
        &self,
        model: &dyn Model,
        condition: usize,
        numerics: &[Numerics],
    ) -> anyhow::Result<Linearization> {
        let usual = numerics.first().cloned().unwrap_or_default();
        let plain = |genes: Vec<f64>, effects: Vec<EffectSetting>| SimulateSpec {
            numerics: usual.clone(),
            ..SimulateSpec::new(
                Individual {
                    effects,
                    ..Individual::new(condition, genes)
                },
                Reply::Channels,
            )
        };
        let values = || self.genes.iter().map(|(_, value)| *value).collect();
        let mut curves = Vec::new();
        for numerics in numerics {
            let spec = SimulateSpec {
                numerics: numerics.clone(),
                ..plain(values(), Vec::new())
            };
            let seen = observed(model, &spec).context("the point cannot be simulated")?;
            curves.push((numerics.clone(), seen.curves));
        }
        let mut own = Linearization {
            curves,
            columns: BTreeMap::new(),
        };
        let names = self.genes.iter().map(|(name, _)| name.clone());
        let names: Vec<String> = names.chain(self.absent.keys().cloned()).collect();
        for names in names.chunks(MAX_COLUMNS) {
            let mut spec = plain(values(), Vec::new());
            spec.columns = names.iter().map(Column::new).collect();
            let seen = observed(model, &spec).context("the point cannot be simulated")?;
            for (name, derivative) in names.iter().zip(seen.columns) {
                if let Derivative::Curves { per, curves } = derivative {
                    own.columns.insert(name.clone(), (per, curves));
                }
            }
        }
        // what has no derivative there has a secant
        for (k, (name, value)) in self.genes.iter().enumerate() {
            if !own.columns.contains_key(name) {
                let mut moved: Vec<f64> = values();
                let step = if *value == 0.0 {
                    0.01
                } else {
                    0.01 * value.abs()
                };
                moved[k] += step;
                let secant = own.secant(model, &plain(moved, Vec::new()), step);
                let secant = secant.with_context(|| format!("{name} cannot be varied"))?;
                own.columns.insert(name.clone(), secant);
            }
        }
        for size in self.library.iter().flat_map(Size::all) {
            if own.columns.contains_key(&size.column()) {
                continue;
            }
            let step = size.of.typical - size.of.absent;
            let step = if step == 0.0 { size.of.scale } else { step };
            let parameters = vec![(size.of.name.clone(), size.of.absent + step)];
            let effects = vec![EffectSetting {
                id: size.effect.to_owned(),
                parameters,
            }];
            if let Some(secant) = own.secant(model, &plain(values(), effects), step) {
                own.columns.insert(size.column(), secant);
            }
        }
        Ok(own)
    }

    /// Returns whether the model is that of the start values of a case with the given numerical settings.
    pub fn is_of(&self, case: &Case, numerics: &[Numerics]) -> bool {
        let genes = case
            .unknowns
            .iter()
            .map(|own| (own.name.clone(), own.start));
        let known = self.conditions.iter().all(|own| {
            let stated = own.curves.iter().map(|(numerics, _)| numerics);
            stated.eq(numerics)
        });
        self.case == case.name && self.genes.iter().cloned().eq(genes) && known
    }

    /// Simulates an individual with the linearised model; returns `None` for an effect that it does not know.
    pub fn observe(&self, spec: &SimulateSpec) -> Option<Observation> {
        let own = self.conditions.get(spec.individual.condition)?;
        let mut all = own.curves.iter();
        let stated = all.find(|(numerics, _)| *numerics == spec.numerics);
        let (_, curves) = stated.or(own.curves.first())?;
        let mut curves = curves.clone();
        for ((name, at), value) in self.genes.iter().zip(&spec.individual.genes) {
            own.move_by(&mut curves, name, [*at, *value])?;
        }
        for effect in &spec.individual.effects {
            for (parameter, value) in &effect.parameters {
                let name = format!("{}.{parameter}", effect.id);
                // a shape has no influence on a linear law
                if let Some(absent) = self.absent.get(&name) {
                    own.move_by(&mut curves, &name, [*absent, *value])?;
                }
            }
        }
        let column = |column: &Column| match own.columns.get(&column.name) {
            Some((per, curves)) => Derivative::Curves {
                per: per.clone(),
                curves: curves.clone(),
            },
            None => Derivative::Nothing {
                per: Per::Unit(String::new()),
            },
        };
        Some(Observation {
            verdict: Verdict::Complete,
            counters: Counters::default(),
            columns: spec.columns.iter().map(column).collect(),
            curves,
        })
    }
}

impl Linearization {
    /// Returns the change of the curves per unit from the point to a neighbour at distance `step`.
    fn secant(
        &self,
        model: &dyn Model,
        spec: &SimulateSpec,
        step: f64,
    ) -> Option<(Per, Vec<Vec<f32>>)> {
        let there = observed(model, spec)?;
        let (_, usual) = self.curves.first()?;
        let curves = there.curves.iter().zip(usual);
        let slope = |(there, here): (&Vec<f64>, &Vec<f64>)| {
            let values = there.iter().zip(here);
            to_single_precision(values.map(|(a, b)| (a - b) / step))
        };
        Some((Per::Unit(String::new()), curves.map(slope).collect()))
    }

    /// Adds the change of the curves by a parameter that moves from one value to another.
    fn move_by(&self, curves: &mut [Vec<f64>], name: &str, [from, to]: [f64; 2]) -> Option<()> {
        let (per, columns) = self.columns.get(name)?;
        let by = match per {
            Per::Decade => libm::log10(to / from),
            Per::Unit(_) => to - from,
        };
        for (curve, column) in curves.iter_mut().zip(columns) {
            for (y, slope) in curve.iter_mut().zip(column) {
                *y += by * f64::from(*slope);
            }
        }
        Some(())
    }
}

/// Size parameter of an effect.
struct Size<'a> {
    effect: &'a str,
    of: &'a ParameterDescriptor,
}

impl<'a> Size<'a> {
    fn all(effect: &'a EffectDescriptor) -> impl Iterator<Item = Self> {
        let each = sizes(effect).into_iter();
        each.map(|k| Self {
            effect: &effect.id,
            of: &effect.parameters[k],
        })
    }

    /// Returns the name of the derivative by the parameter.
    fn column(&self) -> String {
        format!("{}.{}", self.effect, self.of.name)
    }
}

fn observed(model: &dyn Model, spec: &SimulateSpec) -> Option<Observation> {
    let seen = model.observe(spec, false).ok()?;
    (seen.verdict == Verdict::Complete).then_some(seen)
}

/// Laboratory that answers from a linearised model.
#[derive(Debug)]
pub struct LinearLaboratory<'a>(pub &'a LinearModel);

impl Laboratory for LinearLaboratory<'_> {
    type Error = Infallible;

    fn differentiates(&self) -> bool {
        true
    }

    async fn observe(
        &mut self,
        _: Stage,
        batch: Vec<SimulateSpec>,
    ) -> Result<Vec<Option<Observation>>, Infallible> {
        Ok(batch.iter().map(|spec| self.0.observe(spec)).collect())
    }
}
