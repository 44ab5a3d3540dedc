//! How far a gap closes in the metric of the tests, where every channel counts by its own noise: sharper than
//! mean squares of single channels, and what decides whether a name carries.
//!
//! With whitened residuals `r` before and after, `D = |r_b|^2 - |r_a|^2` is what is closed; under noise of
//! variance 1 its standard deviation is `2 |r_b - r_a|`, and as many times more as the answer leaves of it. Of `|r_b|^2 - n` all could be closed. Along the
//! directions in which cycles differ from their mean (their input did) a record says less: with `E` the
//! deviations of the mean that they show, `(I + E E^T)^(-1/2)` is applied to every residual.
use crate::record::measured::{Curves, Record};
use crate::record::metric::Metric;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// The share of a gap that closes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Weighed {
    /// Share of what is left above the noise that closes.
    pub closed: f64,
    /// Its 95 % interval.
    #[serde(rename = "ci95")]
    pub interval: [f64; 2],
    /// Whether the record would show what the models differ by in 95 of 100 cases, if it were all that is missing.
    pub shows: bool,
}

impl Weighed {
    /// Whether the record would show that the gap closes and does not, or shows that it widens: what it could not
    /// show it says nothing of.
    pub fn speaks_against(&self) -> bool {
        let [low, high] = self.interval;
        low <= 0.0 && (self.shows || high <= 0.0)
    }
}

/// A record's mean in a metric.
#[derive(Clone, Debug)]
pub(crate) struct Scale {
    metric: Metric,
    /// What a unit of the metric is, in standard deviations of this record's mean.
    unit: f64,
    measured: DVector<f64>,
    /// Orthonormal directions in which cycles differ, and by how much each is shortened.
    shortened: Option<(DMatrix<f64>, DVector<f64>)>,
}

impl Scale {
    /// A record in the metric of the mean of so many cycles of the same condition and channels; `alike` are
    /// cycles that scatter as its own do, its own among them.
    pub(crate) fn of(record: &Record, alike: &[Curves], metric: &Metric, cycles: usize) -> Self {
        let unit = (record.cycles.len() as f64 / cycles.max(1) as f64).sqrt();
        let own = record.cycles.len();
        Self {
            measured: metric.whiten(&record.mean()),
            shortened: shortened(metric, alike, unit / (own.max(1) as f64).sqrt()),
            metric: metric.clone(),
            unit,
        }
    }

    /// What is left of a record by curves.
    pub(crate) fn left(&self, curves: &Curves) -> DVector<f64> {
        let left = &self.measured - self.metric.whiten(curves);
        let weighed = self.weigh(DMatrix::from_columns(&[left]));
        weighed.column(0).into_owned()
    }

    /// Curves in the metric, before [`Self::weigh`].
    pub(crate) fn whiten(&self, curves: &Curves) -> DVector<f64> {
        self.metric.whiten(curves)
    }

    /// Columns of the metric in standard deviations of this record's mean, shortened where cycles differ.
    pub(crate) fn weigh(&self, columns: DMatrix<f64>) -> DMatrix<f64> {
        let mut columns = columns * self.unit;
        if let Some((u, lost)) = &self.shortened {
            let mut parts = u.tr_mul(&columns);
            for mut part in parts.column_iter_mut() {
                part.component_mul_assign(lost);
            }
            columns -= u * parts;
        }
        columns
    }

    /// How far the gap closes between two models.
    pub(crate) fn weighed(&self, before: &Curves, after: &Curves) -> Weighed {
        /// Normal quantile of a two-sided 95 % interval.
        const QUANTILE: f64 = 1.96;
        /// Normal quantile of what is missed in one case of twenty.
        const MISSED: f64 = 1.645;
        let [before, after] = [before, after].map(|curves| self.left(curves));
        let closed = before.norm_squared() - after.norm_squared();
        let change = (&before - &after).norm();
        // what the answer leaves beyond the noise is noise to a gap, too: errors of model and input there
        let left = (after.norm_squared() / after.len().max(1) as f64).sqrt();
        let noise = left.max(1.0);
        let half = QUANTILE * 2.0 * change * noise;
        let gap = before.norm_squared() - before.len() as f64;
        let whole = gap.max(closed.abs()).max(1.0);
        Weighed {
            closed: closed / whole,
            interval: [(closed - half) / whole, ((closed + half) / whole).min(1.0)],
            // all that is missing would close by the square of the change, with the deviation above
            shows: change > 2.0 * (QUANTILE + MISSED) * noise,
        }
    }
}

/// The directions in which whitened cycles differ from their mean, `deviation` of each being what it is in a
/// record's mean; nothing of fewer than two.
fn shortened(
    metric: &Metric,
    cycles: &[Curves],
    deviation: f64,
) -> Option<(DMatrix<f64>, DVector<f64>)> {
    if cycles.len() < 2 {
        return None;
    }
    let whitened: Vec<DVector<f64>> = cycles.iter().map(|cycle| metric.whiten(cycle)).collect();
    let count = whitened.len() as f64;
    let mean = whitened.iter().sum::<DVector<f64>>() / count;
    let scale = deviation / (count - 1.0).sqrt();
    let each: Vec<DVector<f64>> = whitened.iter().map(|own| (own - &mean) * scale).collect();
    let svd = DMatrix::from_columns(&each).svd(true, false);
    let lost = svd
        .singular_values
        .map(|s| 1.0 - 1.0 / (1.0 + s * s).sqrt());
    svd.u.map(|u| (u, lost))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::measured::{Stated, tests::recorded};
    use crate::record::whitened::WhitenedRecord;
    use protocol::job::Numerics;
    use search::random::{Phase, Streams};

    /// Of records whose gap is about as large as their noise, a change that has nothing to do with it is
    /// hardly ever taken for one that closes it, and the right one mostly is.
    #[test]
    fn intervals_are_as_wide_as_the_noise() {
        const SAMPLES: usize = 240;
        let step = 360.0 / SAMPLES as f64;
        let wave = |size: f64, order: f64| -> Vec<f64> {
            let value = |i: usize| size * libm::sin((order * step * i as f64).to_radians());
            (0..SAMPLES).map(value).collect()
        };
        let mut channel = recorded(0);
        channel.channel.abscissa.points = (0..SAMPLES).map(|i| step * i as f64).collect();
        let streams = Streams::new(11, 0);
        let (mut idle, mut closing) = (0, 0);
        for draw in 0..200 {
            let mut stream = streams.at(0, Phase::Initial, draw);
            let truth = wave(0.25, 3.0);
            let mut cycle = || {
                vec![
                    truth
                        .iter()
                        .map(|y| y + stream.normal())
                        .collect::<Vec<f64>>(),
                ]
            };
            let record = Record {
                condition: 0,
                channels: vec![channel.clone()],
                cycles: (0..8).map(|_| cycle()).collect(),
                held_out: false,
                stated: Stated::default(),
            };
            let on = WhitenedRecord::under_own_noise(record.clone(), 60, Numerics::default());
            let scale = Scale::of(&record, &record.cycles, &on.metric, record.cycles.len());
            let weighed = |after| scale.weighed(&vec![wave(0.0, 1.0)], &vec![after]);
            idle += usize::from(weighed(wave(0.1, 7.0)).interval[0] > 0.0);
            let right = weighed(wave(0.25, 3.0));
            closing += usize::from(right.interval[0] > 0.0);
            assert!(right.closed <= 1.0 && right.interval[1] <= 1.0);
        }
        assert!(idle <= 10, "{idle}");
        assert!(closing >= 180, "{closing}");
    }
}
