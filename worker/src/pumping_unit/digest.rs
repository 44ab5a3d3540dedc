//! Digest of this build's numerics, which shows whether two workers compute the same bits.
use super::effect;
use protocol::id::ContentHash;
use std::sync::OnceLock;

/// Returns the digest of this build's numerics: from the bits of short reference runs (plain, with twin
/// ropes, and with all effects), of derivatives of every kind, and from the catalogue's units and bounds.
/// Equal digests promise equal results. The first call in a process takes as long as those runs.
pub(super) fn of_numerics() -> &'static str {
    static DIGEST: OnceLock<String> = OnceLock::new();
    DIGEST.get_or_init(computed)
}

fn computed() -> String {
    let mut bytes = Vec::new();
    for (bits, statistics) in simulation::reference::fingerprint() {
        bytes.extend(bits.iter().flat_map(|bits| bits.to_le_bytes()));
        bytes.extend_from_slice(format!("{statistics:?}").as_bytes());
    }
    let columns = simulation::reference::columns();
    bytes.extend(columns.iter().flat_map(|bits| bits.to_le_bytes()));
    bytes.extend_from_slice(format!("{:?}", effect::descriptors()).as_bytes());
    ContentHash::of(&bytes).to_string()
}
