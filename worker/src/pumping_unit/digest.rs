//! The name of this build's numerics.
use super::effect;
use protocol::id::ContentHash;
use std::sync::OnceLock;

/// Names the numerics of this build by the bits of short reference runs, as the machine is, with twin
/// ropes and with all effects, by those of derivatives of every kind, and by the catalogue's units and bounds:
/// equal digests promise equal results. Takes as long as those runs the first time in a process.
pub(super) fn of_numerics() -> &'static str {
    static DIGEST: OnceLock<String> = OnceLock::new();
    DIGEST.get_or_init(computed)
}

fn computed() -> String {
    let mut bytes = Vec::new();
    for (bits, statistics) in simulation::reference::name() {
        bytes.extend(bits.iter().flat_map(|bits| bits.to_le_bytes()));
        bytes.extend_from_slice(format!("{statistics:?}").as_bytes());
    }
    let columns = simulation::reference::columns();
    bytes.extend(columns.iter().flat_map(|bits| bits.to_le_bytes()));
    bytes.extend_from_slice(format!("{:?}", effect::descriptors()).as_bytes());
    ContentHash::of(&bytes).to_string()
}
