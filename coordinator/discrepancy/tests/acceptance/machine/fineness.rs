//! Discretisation settings of the stand-in machine.
use discrepancy::baseline::discretisation_check::FinerModel;
use protocol::job::Numerics;

/// Returns the finer discretisations that the machine offers; byte 0 requests shorter elements, byte 1
/// shorter time steps.
pub(crate) fn finer() -> Vec<FinerModel> {
    let one = |(own, settings): ([u8; 2], &str)| FinerModel {
        numerics: Numerics(own.to_vec()),
        settings: settings.to_owned(),
    };
    [
        ([1, 1], "`elements = 20` and `step_s = 0.01`"),
        ([1, 0], "`elements = 20`"),
        ([0, 1], "`step_s = 0.01`"),
    ]
    .map(one)
    .to_vec()
}

/// Returns whether the settings request shorter elements.
pub(super) fn is_shorter(numerics: &Numerics) -> bool {
    numerics.0.first() == Some(&1)
}
