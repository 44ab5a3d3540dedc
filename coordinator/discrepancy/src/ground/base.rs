//! The recalibrated model without further effects, in the metric of all tests.
use crate::ground::preflight::Preflight;
use crate::linear::score::misfit_tail;
use crate::model::fit::Fit;
use crate::record::noise::Known;
use crate::record::whitened::WhitenedRecord;
use crate::thresholds::{STATED, WITHIN};

/// What every test stands on.
pub(crate) struct Base {
    /// The cycles that are fitted, in the final metric.
    pub(crate) on: WhitenedRecord,
    /// The recalibrated model.
    pub(crate) fit: Fit,
    /// Its numerical check; nothing where no finer model completes.
    pub(crate) preflight: Option<Preflight>,
    /// Instruments that the model without effects took far beyond what they are good to, in words; they are held since.
    pub(crate) instruments: Vec<String>,
    /// What else should be known.
    pub(crate) notes: Vec<String>,
}

impl Base {
    /// The squared length of a residual that is noise alone.
    pub(crate) fn noise(&self) -> f64 {
        self.on.metric.len() as f64
    }

    /// What is said of instruments that the model without effects took far beyond what they are good to.
    pub(crate) fn strained(&self) -> Option<String> {
        (!self.instruments.is_empty()).then(|| {
            format!(
                "without effects the fit takes {}, a sign that something else is missing: instruments are held within \
                 {WITHIN} tolerances",
                self.instruments.join(", ")
            )
        })
    }

    /// Whether what a fit leaves may be noise alone, at a level.
    pub(crate) fn explains(&self, fit: &Fit, level: f64) -> bool {
        self.is_noise(fit.chi_squared(), fit.tangent().parameters(), level)
    }

    /// How the noise is known.
    pub(crate) const fn known(&self) -> Known {
        self.on.metric.known()
    }

    /// Whether noise alone may leave so much after a fit of so many effective parameters, at a level; where the
    /// noise is only assumed, whether the assumption bears with what is left.
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
