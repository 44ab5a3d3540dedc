//! Discretisation settings of the stand-in machine.
use protocol::job::Numerics;

/// Returns the finer discretisations that the machine offers; byte 0 requests shorter elements, byte 1
/// shorter time steps.
pub(crate) fn finer() -> Vec<Numerics> {
    [[1, 1], [1, 0], [0, 1]]
        .map(|own| Numerics(own.to_vec()))
        .to_vec()
}

/// Returns whether the settings request shorter elements.
pub(super) fn is_shorter(numerics: &Numerics) -> bool {
    numerics.0.first() == Some(&1)
}
