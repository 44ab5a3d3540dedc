//! Working conditions of a case.
use serde::{Deserialize, Serialize};

/// Working condition under which the machine is simulated and measured, such as a speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// Short name of the condition, e.g. `5rpm`.
    pub name: String,
}
