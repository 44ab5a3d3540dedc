//! Errors of a measurement's input that differ from cycle to cycle: directions that no test counts as a
//! disagreement. The reader of the data sheet maps each to a shift of the abscissa or to an effect of the
//! library. Errors that are constant over a measurement belong to `nuisance`.
use serde::{Deserialize, Serialize};

/// Source of scatter between cycles that comes from their input.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum InputScatter {
    /// Shift of a cycle's curves along the abscissa.
    Abscissa {
        /// Largest shift of a cycle along the abscissa, in the abscissa's unit.
        tolerance: f64,
    },
    /// Effect of the library that acts on the input; ignored where the library lacks it.
    Effect {
        /// Identifier of the effect in the library.
        id: String,
        /// Standard deviation of the effect's first size from cycle to cycle, in that size's unit.
        deviation: f64,
    },
}
