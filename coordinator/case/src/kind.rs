//! Kinds of models that this program knows; a model of any other kind is read, shown and printed in the general form.
//!
//! A kind has its name here, and an implementation of a trait in each part of the program in which it has a form of its
//! own: of [`ModelKind`] here, of `ModelReport` in `report`, of `ModelOutput` in the command line.
use crate::case_kind::ModelKind;
use protocol::{case::Case, external, pumping_unit::Machine};

pub use crate::{
    case_kind::OtherModel, command::kind::CommandModel, pumping_unit::kind::PumpingUnitModel,
};

/// Kind of a model, as this program distinguishes them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum KnownKind {
    /// Pumping unit with double horse heads.
    PumpingUnit,
    /// Program of the user's own.
    Command,
    /// Any other model, which only its workers know.
    Other,
}

impl KnownKind {
    /// All kinds.
    pub const ALL: [Self; 3] = [Self::PumpingUnit, Self::Command, Self::Other];

    /// Returns the kind with a name, of which the part before a colon counts, as `command` of `command:decay`.
    pub fn named(name: &str) -> Self {
        match name.split_once(':').map_or(name, |(kind, _)| kind) {
            Machine::KIND => Self::PumpingUnit,
            external::KIND => Self::Command,
            _ => Self::Other,
        }
    }

    /// Returns the kind of model of a case.
    pub fn of(case: &Case) -> Self {
        Self::named(&case.model.kind)
    }

    /// Returns how cases of this kind are read.
    pub const fn form(self) -> &'static dyn ModelKind {
        match self {
            Self::PumpingUnit => &PumpingUnitModel,
            Self::Command => &CommandModel,
            Self::Other => &OtherModel,
        }
    }
}

/// Returns how cases of a case's kind of model are read.
pub fn of(case: &Case) -> &'static dyn ModelKind {
    KnownKind::of(case).form()
}
