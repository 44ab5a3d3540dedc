//! Programs of the user's own as reports and objects ask for them.
use super::report::Files;
use crate::{kind::Kind, report::Drawing};
use protocol::external::KIND;

/// Models that are programs of the user's own.
pub(crate) struct Externals;

impl Kind for Externals {
    fn name(&self) -> &'static str {
        KIND
    }

    fn drawing(&self) -> &'static dyn Drawing {
        &Files
    }
}
