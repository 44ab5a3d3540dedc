//! The name of this build's numerics.
use super::effect;
use protocol::id::ContentHash;
use std::sync::OnceLock;

/// Names the numerics of this build by the bits of two reference runs, without effects and with all of
/// them, and by the catalogue's units and bounds: equal digests promise equal results. Takes as long
/// as those runs, some tenths of a second, the first time in a process.
pub(super) fn of_numerics() -> &'static str {
    static DIGEST: OnceLock<String> = OnceLock::new();
    DIGEST.get_or_init(computed)
}

fn computed() -> String {
    let mut bytes = Vec::new();
    let plain = simulation::reference::bits();
    for (bits, statistics) in [plain, simulation::reference::bits_with_effects()] {
        bytes.extend(bits.iter().flat_map(|bits| bits.to_le_bytes()));
        bytes.extend_from_slice(format!("{statistics:?}").as_bytes());
    }
    bytes.extend_from_slice(format!("{:?}", effect::descriptors()).as_bytes());
    ContentHash::of(&bytes).to_string()
}
