//! Baseline: the recalibrated model without further effects, in the metric of all tests.
use crate::baseline::discretisation_check::Preflight;
use crate::linear::score::misfit_tail;
use crate::linear::whitened::WhitenedRecord;
use crate::model::fit::Fit;
use crate::thresholds::WITHIN;
use record::metric::Metric;
use record::noise::NoiseSource;
use record::noise::STATED;

/// Baseline of all hypothesis tests: the recalibrated model without further effects.
pub(crate) struct Baseline {
    /// Fitted record, whitened with the noise metric of all hypothesis tests.
    pub(crate) record: WhitenedRecord,
    /// Fit of the recalibrated model.
    pub(crate) fit: Fit,
    /// Comparison of the recalibrated model with a finer discretisation; `None` where no finer model
    /// completes.
    pub(crate) preflight: Option<Preflight>,
    /// Descriptions of the instruments whose estimated error was far beyond tolerance in the model without
    /// effects, and which are therefore constrained to their tolerance.
    pub(crate) instruments: Vec<String>,
    /// Remarks on the baseline for the user.
    pub(crate) notes: Vec<String>,
}

impl Baseline {
    /// Lets the model and all that are fitted from here on compete with a smooth discrepancy.
    #[must_use]
    pub(crate) fn with_discrepancy(mut self) -> Self {
        self.record = self.record.with_discrepancy();
        self.fit = self.fit.competing(self.record.smooth.clone());
        self
    }

    /// Returns the expected squared length of the whitened residual if it is noise alone: its number of
    /// entries.
    pub(crate) fn noise(&self) -> f64 {
        self.record.metric.len() as f64
    }

    /// Describes the instruments whose estimated error in the model without effects is far beyond their
    /// tolerance, if there are any.
    pub(crate) fn instruments_beyond_tolerance(&self) -> Option<String> {
        (!self.instruments.is_empty()).then(|| {
            format!(
                "without effects the fit needs {}, which indicates a missing effect: instruments are therefore limited to \
                 {WITHIN} tolerances",
                self.instruments.join(", ")
            )
        })
    }

    /// Returns whether the residual of a fit may be noise alone, at a significance level.
    pub(crate) fn explains(&self, fit: &Fit, level: f64) -> bool {
        self.is_noise(fit.chi_squared(), fit.tangent().parameters(), level)
    }

    /// Returns whether the noise level of the record was measured by repeated cycles, stated or estimated
    /// from one curve.
    pub(crate) const fn known(&self) -> NoiseSource {
        self.record.metric.known()
    }

    /// Returns whether noise alone may leave this `chi^2` after a fit of `parameters` effective parameters,
    /// at a significance level; where the noise was not measured by repeated cycles, whether `chi^2` is
    /// compatible with the stated or assumed noise.
    pub(crate) fn is_noise(&self, chi_squared: f64, parameters: f64, level: f64) -> bool {
        let record = &self.record;
        let cycles = record.record.cycles.len();
        is_noise(&record.metric, cycles, (chi_squared, parameters), level)
    }
}

/// Returns whether noise alone may leave this `chi^2` of the mean of `cycles` cycles in a metric, after a fit
/// of `parameters` effective parameters, at a significance level; where the noise was not measured by repeated
/// cycles, whether `chi^2` is compatible with the stated or assumed noise.
fn is_noise(
    metric: &Metric,
    cycles: usize,
    (chi_squared, parameters): (f64, f64),
    level: f64,
) -> bool {
    let n = metric.len();
    if !metric.known().is_seen() {
        let left = (n as f64 - parameters).max(1.0);
        return (1.0 / STATED..=STATED).contains(&(chi_squared / left));
    }
    let expected = metric.student_variances().mean();
    let freedom = n as f64 * (cycles as f64 - 1.0);
    misfit_tail(chi_squared / expected, n, parameters, freedom) >= level
}

#[cfg(test)]
mod tests {
    use super::*;
    use record::basis::ChannelGroup;
    use record::noise::Noise;
    use record::{Record, Stated, recorded};
    use search::random::{Phase, Streams};

    /// Counts the records of white noise, of 120 orders each, whose residual under the true model is called
    /// more than noise at a level of 1e-3.
    fn rejected(cycles: usize, channels: usize, sets: u64) -> usize {
        let is_rejected = |seed: &u64| {
            let mut channels: Vec<_> = (0..channels).map(recorded).collect();
            for own in &mut channels {
                own.channel.abscissa.points = (0..360).map(f64::from).collect();
            }
            let cycle = |k: usize| {
                let mut stream = Streams::new(*seed, 77).at(0, Phase::Resample, k);
                let curve = |_| (0..360).map(|_| stream.normal()).collect();
                channels.iter().map(curve).collect()
            };
            let record = Record {
                condition: 0,
                cycles: (0..cycles).map(cycle).collect(),
                channels: channels.clone(),
                held_out: false,
                stated: Stated::default(),
            };
            let groups = ChannelGroup::of(&record, 120, &[]);
            let metric = Metric::new(&groups, &Noise::estimate(&record, &groups, &[]));
            let left = metric.whiten(&record.mean()).norm_squared();
            !is_noise(&metric, cycles, (left, 0.0), 1e-3)
        };
        (0..sets).filter(is_rejected).count()
    }

    /// Checks the level of the misfit test where the covariances of several channels come from few cycles: an
    /// inverse covariance that is too large in the mean rejects up to one record in eight.
    #[test]
    fn noise_alone_is_noise_with_few_cycles_and_many_channels() {
        for (cycles, channels) in [(2, 1), (2, 4), (2, 6), (3, 6), (4, 6)] {
            let count = rejected(cycles, channels, 100);
            assert!(
                count <= 1,
                "{count} of 100: {cycles} cycles, {channels} channels"
            );
        }
    }
}
