//! Baseline: the recalibrated model without further effects, in the metric of all tests.
use crate::baseline::discretisation_check::Preflight;
use crate::linear::score::misfit_tail;
use crate::model::fit::Fit;
use crate::record::noise::NoiseSource;
use crate::record::whitened::WhitenedRecord;
use crate::thresholds::{STATED, WITHIN};

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
        let n = self.record.metric.len();
        if !self.known().is_seen() {
            let left = (n as f64 - parameters).max(1.0);
            return (1.0 / STATED..=STATED).contains(&(chi_squared / left));
        }
        let freedom = n as f64 * (self.record.record.cycles.len() as f64 - 1.0);
        misfit_tail(chi_squared, n, parameters, freedom) >= level
    }
}
