//! Baseline: the recalibrated model without further effects, in the metric of all tests.
use crate::ground::preflight::Preflight;
use crate::linear::score::misfit_tail;
use crate::model::fit::Fit;
use crate::record::noise::Known;
use crate::record::whitened::WhitenedRecord;
use crate::thresholds::{STATED, WITHIN};

/// Baseline of all tests.
pub(crate) struct Base {
    /// Fitted record in the final metric.
    pub(crate) on: WhitenedRecord,
    /// Fit of the recalibrated model.
    pub(crate) fit: Fit,
    /// Numerical check of the model; `None` where no finer model completes.
    pub(crate) preflight: Option<Preflight>,
    /// Descriptions of the instruments that the model without effects moved far beyond their tolerance, and
    /// that are constrained since.
    pub(crate) instruments: Vec<String>,
    /// Remarks for the user.
    pub(crate) notes: Vec<String>,
}

impl Base {
    /// Returns the expected squared length of a residual that is noise alone.
    pub(crate) fn noise(&self) -> f64 {
        self.on.metric.len() as f64
    }

    /// Describes the instruments that the model without effects moved far beyond their tolerance, if there
    /// are any.
    pub(crate) fn strained(&self) -> Option<String> {
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

    /// Returns the source of the noise level.
    pub(crate) const fn known(&self) -> Known {
        self.on.metric.known()
    }

    /// Returns whether noise alone may leave this `chi^2` after a fit of `parameters` effective parameters,
    /// at a significance level; where the noise is only assumed, whether the assumption is compatible with
    /// the residual.
    pub(crate) fn is_noise(&self, chi_squared: f64, parameters: f64, level: f64) -> bool {
        let n = self.on.metric.len();
        if !self.known().is_seen() {
            let left = (n as f64 - parameters).max(1.0);
            return (1.0 / STATED..=STATED).contains(&(chi_squared / left));
        }
        let freedom = n as f64 * (self.on.record.cycles.len() as f64 - 1.0);
        misfit_tail(chi_squared, n, parameters, freedom) >= level
    }
}
