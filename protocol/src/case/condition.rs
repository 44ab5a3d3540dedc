//! Working conditions.
use serde::{Deserialize, Serialize};

/// One working condition.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Condition {
    /// Short name, as `5rpm`.
    pub name: String,
}
