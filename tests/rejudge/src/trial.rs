//! Trials: synthetic records of a linearised model, their diagnoses, and the rates of names.
use crate::linear::{LinearLaboratory, LinearModel};
use anyhow::Context as _;
use discrepancy::diagnose::{Diagnosis, Inputs, Limit, diagnose};
use discrepancy::thresholds::Thresholds;
use discrepancy::verdict::Verdict;
use protocol::announce::{EffectDescriptor, Sign};
use protocol::case::{Abscissa, Case, EffectSetting};
use protocol::job::{Individual, Numerics, Reply, SimulateSpec};
use record::Record;
use search::random::{Phase, Stream, Streams};
use search::space::Space;
use std::f64::consts::TAU;
use std::fmt;
use std::pin::pin;
use std::task::{Context, Poll, Waker};

/// Case on whose records trials are made.
#[derive(Debug)]
pub struct Rig<'a> {
    /// Linearised model of the case.
    pub model: &'a LinearModel,
    /// Case whose unknowns and conditions the model has.
    pub case: &'a Case,
    /// Records of the case, that of the calibrated condition first; channels, stated noise and scatter of the
    /// cycles are theirs.
    pub records: Vec<Record>,
    /// Numerical settings with which a diagnosis simulates, the usual one first.
    pub numerics: Vec<Numerics>,
    /// Thresholds of the diagnoses.
    pub thresholds: Thresholds,
}

/// Content of the records of a row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Standard deviation of the smooth model error, drawn anew for each condition (standard errors of the mean
    /// of the record).
    pub model_error: f64,
    /// Share of the noise variance that is slow: first-order noise with a correlation length of a twentieth of
    /// the record.
    pub slow: f64,
    /// Whether the records of other conditions are kept.
    pub conditions: bool,
    /// Hidden size in detection limits; 0 hides nothing.
    pub times: f64,
}

impl fmt::Display for Trial {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{:>8} | {:>11} | {:>10} | {:>9}",
            self.times,
            self.model_error,
            self.slow,
            if self.conditions { "with" } else { "without" }
        )
    }
}

/// Counts of a row of the table.
#[derive(Clone, Debug, Default)]
pub struct Counts {
    /// Number of records.
    pub sets: usize,
    /// Number of records of which the hidden effect is in the set that was named.
    pub right: usize,
    /// One line for each record whose hidden effect got no name.
    pub missed: Vec<String>,
    /// One line for each record that got another name, or one although nothing is hidden.
    pub wrong: Vec<String>,
}

impl<'a> Rig<'a> {
    /// Creates the rig of a linearised case with its records and the numerical settings with which a diagnosis
    /// simulates it, under the default thresholds.
    pub fn new(
        model: &'a LinearModel,
        case: &'a Case,
        (mut records, numerics): (Vec<Record>, Vec<Numerics>),
    ) -> Self {
        records.sort_by_key(|record| record.condition != case.objective.condition);
        Self {
            model,
            case,
            records,
            numerics,
            thresholds: Thresholds::default(),
        }
    }

    /// Diagnoses `sets` records of a row. The effects of the library are hidden in turn; `limits` are the detection
    /// limits of the case.
    ///
    /// # Errors
    /// A case whose unknowns span no space.
    pub fn counts(&self, trial: Trial, sets: u64, limits: &[Limit]) -> anyhow::Result<Counts> {
        let mut counts = Counts::default();
        let hideable = |limit: &&Limit| {
            trial.times * limit.size <= limit.largest && self.effect(&limit.id).is_some()
        };
        let limits: Vec<&Limit> = limits.iter().filter(hideable).collect();
        let mut hidden = limits.into_iter().cycle();
        for seed in 0..sets {
            let hidden = hidden.next().filter(|_| trial.times > 0.0);
            let answer = self.diagnosed(trial, hidden, seed)?;
            let claims = matches!(
                answer.verdict,
                Verdict::Named | Verdict::Ambiguous | Verdict::Unlisted
            );
            let mut sets = answer.rounds.iter().map(|round| &round.set);
            let right = hidden.is_some_and(|own| sets.any(|set| set.contains(&own.id)));
            counts.sets += 1;
            let line = || {
                let named: Vec<&str> = answer.effects.iter().map(|own| &*own.id).collect();
                let hidden = hidden.map_or("nothing", |own| &own.id);
                let (verdict, reason) = (answer.verdict, &answer.reason);
                format!(
                    "{hidden}: {verdict:?} {named:?} {:?} {reason:?}",
                    answer.generic
                )
            };
            if claims && right {
                counts.right += 1;
            } else if claims {
                counts.wrong.push(line());
            } else if hidden.is_some() {
                counts.missed.push(line());
            }
        }
        Ok(counts)
    }

    /// Returns the detection limits that the diagnosis of a record without an effect prints.
    ///
    /// # Errors
    /// As [`Self::counts`].
    pub fn limits(&self) -> anyhow::Result<Vec<Limit>> {
        let nothing = Trial {
            model_error: 0.0,
            slow: 0.0,
            conditions: true,
            times: 0.0,
        };
        Ok(self.diagnosed(nothing, None, u64::MAX)?.limits)
    }

    fn effect(&self, id: &str) -> Option<&EffectDescriptor> {
        let mut all = self.model.library.iter();
        all.find(|effect| effect.id == id && !effect.generic)
    }

    /// Diagnoses the records of one seed.
    fn diagnosed(
        &self,
        trial: Trial,
        hidden: Option<&Limit>,
        seed: u64,
    ) -> anyhow::Result<Diagnosis> {
        let space = Space::new(&self.case.unknowns)?;
        let streams = Streams::new(seed, 0);
        let stream = &mut streams.at(0, Phase::Initial, 0);
        let values: Vec<f64> = self.model.genes.iter().map(|(_, value)| *value).collect();
        let point = space.point(&values);
        let truth: Vec<f64> = point
            .iter()
            .map(|x| (x + 0.02 * stream.normal()).clamp(0.0, 1.0))
            .collect();
        let effect = hidden.and_then(|limit| {
            let own = self.effect(&limit.id)?;
            let of = own.parameters.iter().find(|p| p.name == limit.parameter)?;
            let negative = of.sign == Sign::Either && stream.chance(0.5);
            let size = trial.times * limit.size * if negative { -1.0 } else { 1.0 };
            Some(EffectSetting {
                id: own.id.clone(),
                parameters: vec![(of.name.clone(), of.absent + size)],
            })
        });
        let kept = if trial.conditions {
            self.records.len()
        } else {
            1
        };
        let mut records = Vec::new();
        for record in &self.records[..kept] {
            let individual = Individual {
                effects: effect.clone().into_iter().collect(),
                ..Individual::new(record.condition, space.values(&truth))
            };
            records.push(self.record(record, (trial, individual), stream)?);
        }
        let inputs = Inputs {
            conditions: self
                .case
                .conditions
                .iter()
                .map(|own| own.name.clone())
                .collect(),
            unknowns: self.case.unknowns.clone(),
            space,
            records,
            library: self.model.library.clone(),
            families: None,
            start: Some(point),
            usual: self.numerics.first().cloned().unwrap_or_default(),
            finer: self.numerics.iter().skip(1).cloned().collect(),
            global_search: "least-squares",
            seed: 1,
            thresholds: self.thresholds.clone(),
            differentiates: true,
            differences: false,
        };
        let mut laboratory = LinearLaboratory(self.model);
        let mut work = pin!(diagnose(&mut laboratory, &inputs));
        match work.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(Ok(diagnosis)) => Ok(diagnosis),
            Poll::Ready(Err(never)) => match never {},
            Poll::Pending => unreachable!("a laboratory that answers at once never waits"),
        }
    }

    /// Makes a record like another one, of the curves of an individual.
    fn record(
        &self,
        like: &Record,
        (trial, individual): (Trial, Individual),
        stream: &mut Stream,
    ) -> anyhow::Result<Record> {
        let spec = SimulateSpec {
            numerics: self.numerics.first().cloned().unwrap_or_default(),
            ..SimulateSpec::new(individual, Reply::Channels)
        };
        let seen = self.model.observe(&spec).context("the effect is unknown")?;
        let variance = like.cycle_variance();
        let mut record = like.clone();
        record.cycles.iter_mut().for_each(Vec::clear);
        let count = record.cycles.len();
        for (c, own) in like.channels.iter().enumerate() {
            let curve = seen.curves.get(own.curve).and_then(|curve| own.pick(curve));
            let curve = curve.context("the record has a channel that the model lacks")?;
            let stated = own.channel.noise.map(|noise| noise * noise);
            let seen = variance.get(c).copied().filter(|own| *own > 0.0);
            let noise = seen.or(stated).context("a channel has no noise")?.sqrt();
            let mut error = vec![0.0; curve.len()];
            add_smooth(
                &mut error,
                &own.channel.abscissa,
                trial.model_error * noise / (count as f64).sqrt(),
                stream,
            );
            for cycle in &mut record.cycles {
                let noise = add_noise(curve.len(), noise, trial.slow, stream);
                let values = curve.iter().zip(&error).zip(noise);
                cycle.push(
                    values
                        .map(|((y, error), noise)| y + error + noise)
                        .collect(),
                );
            }
        }
        Ok(record)
    }
}

/// Adds a smooth random curve of a given standard deviation, with a correlation length of a twentieth of the
/// abscissa.
fn add_smooth(curve: &mut [f64], abscissa: &Abscissa, deviation: f64, stream: &mut Stream) {
    /// Highest order: the spectrum has fallen to a hundredth there.
    const ORDERS: u32 = 10;
    let points = &abscissa.points;
    let ends = [points.first(), points.last()].map(|x| x.copied().unwrap_or_default());
    // without a period the curve repeats after one and a half times the record
    let span = abscissa.period.unwrap_or(1.5 * (ends[1] - ends[0]));
    let share = |order: u32| libm::exp(-0.5 * (TAU * f64::from(order) / 20.0).powi(2));
    let whole: f64 = (1..=ORDERS).map(share).sum();
    for order in 1..=ORDERS {
        let scale = deviation * (share(order) / whole).sqrt();
        let [a, b] = [0, 1].map(|_| scale * stream.normal());
        for (y, x) in curve.iter_mut().zip(points) {
            let turn = TAU * f64::from(order) * (x - ends[0]) / span;
            *y += a * libm::cos(turn) + b * libm::sin(turn);
        }
    }
}

/// Draws noise of which a share of the variance is slow.
fn add_noise(count: usize, deviation: f64, slow: f64, stream: &mut Stream) -> Vec<f64> {
    let keep = libm::exp(-20.0 / count.max(1) as f64);
    let mut state = stream.normal();
    let mut value = || {
        let own = slow.sqrt() * state + (1.0 - slow).sqrt() * stream.normal();
        state = keep * state + (1.0 - keep * keep).sqrt() * stream.normal();
        deviation * own
    };
    (0..count).map(|_| value()).collect()
}

/// Returns the rows of the table: nothing hidden, and effects at a multiple of their detection limits, by model error,
/// slow noise and the presence of other conditions.
pub fn rows(times: f64) -> Vec<Trial> {
    let mut rows = Vec::new();
    for times in [0.0, times] {
        for conditions in [true, false] {
            let row = |model_error: f64, slow: f64| Trial {
                model_error,
                slow,
                conditions,
                times,
            };
            rows.extend([0.0, 0.3, 1.0, 3.0].map(|error| row(error, 0.0)));
            rows.push(row(0.0, 0.5));
        }
    }
    rows
}
