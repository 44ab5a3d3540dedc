//! Comparison of two models (before and after the answer's effects are added) with every record, fitted or
//! held out.
use crate::baseline::discretisation_check;
use crate::baseline::input_error::{InputError, input_errors};
use crate::baseline::session::Session;
use crate::laboratory::{Laboratory, Stage, channels};
use crate::linear::discrepancy::{Discrepancy, SmoothBasis};
use crate::linear::waves::smooth_basis;
use crate::linear::whitened::WhitenedRecord;
use crate::model::experiments::Experiments;
use crate::model::fit::Fit;
use crate::validation::gap_closure::{Closed, gap_closure};
use crate::validation::scoring_metric::ScoringMetric;
use nalgebra::DMatrix;
use record::basis::ChannelGroup;
use record::metric::Metric;
use record::noise::Noise;
use record::{Acts, Nuisance};
use record::{Curves, Record, Split};
use serde::{Deserialize, Serialize};

/// Gap between record and model on one record, before and after the answer's effects are added.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct GapRow {
    /// Index of the record's working condition in the case.
    pub condition: usize,
    /// Role of the record: fitted, or which kind of held-out data it is.
    pub part: DataRole,
    /// Whether the case itself holds this record out: by its condition, its channels or parts of channels.
    pub held_out: bool,
    /// Gap on the record before and after effects are added, and the share that they close.
    pub closed: Closed,
    /// Curves simulated by the model before effects are added, by channel.
    pub before: Curves,
    /// Curves simulated by the model after effects are added, by channel.
    pub after: Curves,
}

/// Part of the data on which a gap is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum DataRole {
    /// Cycles that were fitted.
    Fitted,
    /// Cycles of the calibrated condition that took no part in the fit.
    Cycles,
    /// Channels of the calibrated condition that took no part in the fit, and no other channel.
    Channels,
    /// Parts of channels of the calibrated condition that took no part in the fit; no channel is held out as
    /// a whole.
    Segment,
    /// Record of another working condition than the calibrated one.
    Condition,
}

impl DataRole {
    /// Describes the part of the data in words; `condition` is the description of its condition.
    pub(crate) fn words(self, condition: &str) -> String {
        match self {
            Self::Fitted => "the cycles that were fitted".to_owned(),
            Self::Cycles => "the cycles that were held out".to_owned(),
            Self::Channels => "the channels that were held out".to_owned(),
            Self::Segment => "the part of the record that was held out".to_owned(),
            Self::Condition => condition.to_owned(),
        }
    }
}

/// Measured record on which the answer of a diagnosis is validated.
#[derive(Clone, Debug)]
pub(crate) struct ValidationRecord<'a> {
    pub(crate) record: &'a Record,
    /// Cycles of the same channels and condition with the same scatter as the record, including its own.
    pub(crate) alike: Vec<Curves>,
    /// Metric that expresses residuals of the record in units of its own uncertainty.
    pub(crate) scale: ScoringMetric,
    /// Role of the record: fitted, or which kind of held-out data it is.
    pub(crate) part: DataRole,
    /// Waves of the record's own discrepancy; no wave where it shares that of the fitted cycles.
    smooth: SmoothBasis,
}

impl ValidationRecord<'_> {
    /// Returns the waves of the record's own discrepancy, each times the standard deviation of its coefficient: in
    /// each channel as strong as `needed` in the channel of the same name of the fitted record; in one that was not
    /// fitted as many standard errors as in the fitted ones (median), and as long.
    pub(crate) fn waves(
        &self,
        needed: Option<&Discrepancy>,
        (model, fitted): (&Fit, &Record),
    ) -> DMatrix<f64> {
        let Some((found, basis)) = needed.zip(model.smooth.as_ref()) else {
            return DMatrix::zeros(self.scale.len(), 0);
        };
        let strength = basis.strength(found);
        let own = self.record.channels.iter().zip(self.smooth.scales());
        let own = own.map(|(own, scale)| {
            let mut same = fitted.channels.iter();
            let same = same.position(|other| other.channel.name == own.channel.name);
            same.map_or(strength * scale, |k| found.deviations[k])
        });
        let [whole, part] = [fitted, self.record].map(|record| {
            let [from, to] = record.span();
            to - from
        });
        self.smooth.scaled(&Discrepancy {
            deviations: own.collect(),
            length: found.length * whole / part.max(f64::MIN_POSITIVE),
        })
    }
}

/// Collects the records on which an answer is validated: the calibrated condition's record in parts, in the
/// metric of the tests, then the other conditions, each under its own noise and its own input errors.
///
/// # Errors
/// Those of the laboratory.
pub(crate) async fn validation_records<'a, L: Laboratory>(
    session: &mut Session<'a, L>,
    split: &'a Split,
) -> Result<Vec<ValidationRecord<'a>>, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let whole = split.channels.channels.iter().any(|own| own.rows.is_none());
    let apart = if whole {
        DataRole::Channels
    } else {
        DataRole::Segment
    };
    let parts = [
        (&split.fitted, DataRole::Fitted),
        (&split.cycles, DataRole::Cycles),
        (&split.channels, apart),
    ];
    let others = inputs.records.iter().skip(1);
    let others = others.map(|record| (record, DataRole::Condition));
    let there = |(record, _): &(&Record, DataRole)| {
        !record.cycles.is_empty() && !record.channels.is_empty()
    };
    let mut shown = Vec::new();
    for (record, part) in parts.into_iter().chain(others).filter(there) {
        let (alike, scale) = match part {
            DataRole::Fitted | DataRole::Cycles => {
                let alike = [&split.fitted.cycles[..], &split.cycles.cycles].concat();
                // in the directions of fitted cycles alone: what is held out must not shorten its own residual
                let cycles = &split.fitted.cycles;
                let scale = ScoringMetric::of(record, cycles, &base.record.metric, cycles.len());
                (alike, scale)
            }
            DataRole::Channels | DataRole::Segment | DataRole::Condition => {
                let scale = elsewhere(session, record).await?;
                (record.cycles.clone(), scale)
            }
        };
        let own = match part {
            DataRole::Fitted | DataRole::Cycles => None,
            DataRole::Channels | DataRole::Segment | DataRole::Condition => Some(record),
        };
        let whiten = |curves: &Curves| {
            let whitened = DMatrix::from_columns(&[scale.whiten(curves)]);
            scale.weigh(whitened).column(0).into_owned()
        };
        let smooth = own.map_or_else(SmoothBasis::default, |record| {
            smooth_basis(record, scale.standard_error(), whiten)
        });
        shown.push(ValidationRecord {
            record,
            alike,
            scale,
            part,
            smooth,
        });
    }
    Ok(shown)
}

/// Builds the scale of a record that took no part in the fit, from its own noise, the errors of its input,
/// the instruments that only it has, and the numerical error of the model there after a refit to the finer
/// model.
async fn elsewhere<L: Laboratory>(
    session: &mut Session<'_, L>,
    record: &Record,
) -> Result<ScoringMetric, L::Error> {
    let (base, inputs) = (session.base, session.inputs);
    let highest = inputs.thresholds.orders;
    let numerics = base.record.numerics.clone();
    let own = WhitenedRecord::under_own_noise(record.clone(), highest, numerics);
    let groups = ChannelGroup::of(record, highest, &[]);
    let mut noise = Noise::estimate(record, &groups, &[]);
    let mut directions = Vec::new();
    let mut experiments = session.experiments(Stage::Show);
    let mut experiments = experiments.for_record(&own);
    if let Some(seen) = experiments.linearized(&base.fit, record).await? {
        let at = (&base.fit, &seen.curves);
        let errors = input_errors(&mut experiments, at, &inputs.library).await?;
        let scaled = |error: InputError| scaled(error.curves, error.deviation);
        directions.extend(errors.into_iter().map(scaled));
        directions.extend(instruments(&base.fit, record, &seen.curves));
        if let Some(first) = &base.preflight {
            let mut finer = experiments.for_stage(Stage::Preflight);
            let at = (&base.fit, &seen.curves);
            let changed = discretisation_check::changed(&mut finer, at, &inputs.finer).await?;
            if let Some((mut changed, _)) = changed {
                // what a refit to the finer model would move the unknowns by moves this record, too
                let whitened = base.record.metric.whiten(&first.difference);
                for (k, moved) in base.fit.tangent().estimate(&whitened) {
                    let Some(by) = &seen.changes[k] else { continue };
                    let values = changed.iter_mut().flatten().zip(by.iter().flatten());
                    values.for_each(|(value, by)| *value += moved * by);
                }
                noise.add_error(&groups, &own.metric.entries(&changed));
            }
        }
    }
    let mut metric = Metric::new(&groups, &noise);
    let directions: Vec<_> = directions.iter().map(|own| metric.whiten(own)).collect();
    metric.marginalize(&directions);
    let cycles = record.cycles.len();
    Ok(ScoringMetric::of(record, &record.cycles, &metric, cycles))
}

/// Returns the change of a record's curves by one standard deviation of each instrument gain that the fit
/// does not contain.
fn instruments(fit: &Fit, record: &Record, curves: &Curves) -> Vec<Curves> {
    let known = |own: &Nuisance| {
        let mut all = fit.model.nuisances.iter();
        all.any(|one| one.nuisance.acts == own.acts && one.nuisance.id == own.id)
    };
    let own = record.stated.nuisances.iter().filter(|own| !known(own));
    own.filter_map(|own| {
        let Acts::Gain { curve } = own.acts else {
            return None;
        };
        let channel = record.channels.iter().position(|c| c.curve == curve)?;
        let mut change: Curves = curves.iter().map(|c| vec![0.0; c.len()]).collect();
        change[channel].clone_from(&curves[channel]);
        Some(scaled(change, own.deviation))
    })
    .collect()
}

fn scaled(mut curves: Curves, by: f64) -> Curves {
    curves.iter_mut().flatten().for_each(|value| *value *= by);
    curves
}

/// Computes the gaps of two models on validation records; a record on which a model fails is left out.
pub(crate) async fn compare<L: Laboratory>(
    experiments: &mut Experiments<'_, L>,
    records: &[ValidationRecord<'_>],
    before: &Fit,
    after: &Fit,
) -> Result<Vec<GapRow>, L::Error> {
    let numerics = &experiments.on.numerics;
    let points = [before, after].map(Fit::point);
    let both = |shown: &ValidationRecord<'_>| {
        let condition = shown.record.condition;
        points
            .each_ref()
            .map(|point| point.experiment(condition, numerics))
    };
    let batch = records.iter().flat_map(both).collect();
    let observed = experiments.lab.observe(experiments.stage, batch).await?;
    let rows = records
        .iter()
        .zip(observed.chunks(2))
        .filter_map(|(shown, pair)| {
            let curves = |k: usize| {
                let mut curves = channels(pair.get(k)?.as_ref()?, shown.record)?;
                points[k].apply_gains(shown.record, &mut curves);
                Some(curves)
            };
            let (before, after) = (curves(0)?, curves(1)?);
            Some(GapRow {
                condition: shown.record.condition,
                part: shown.part,
                held_out: shown.record.held_out
                    || matches!(shown.part, DataRole::Channels | DataRole::Segment),
                closed: gap_closure(shown.record, &shown.alike, &before, &after),
                before,
                after,
            })
        });
    Ok(rows.collect())
}
