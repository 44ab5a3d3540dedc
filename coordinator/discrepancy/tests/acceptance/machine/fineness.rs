//! How finely the machine is computed.
use protocol::job::Numerics;

/// What the machine's own numerics may ask for: shorter elements, shorter steps, in a byte each.
pub(crate) fn finer() -> Vec<Numerics> {
    [[1, 1], [1, 0], [0, 1]]
        .map(|own| Numerics(own.to_vec()))
        .to_vec()
}

/// Whether they ask for shorter elements.
pub(super) fn is_shorter(numerics: &Numerics) -> bool {
    numerics.0.first() == Some(&1)
}
