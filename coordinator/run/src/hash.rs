//! Hashes of what a run is about: they name runs, and tell whether a case was changed.
use protocol::{case::Case, id::ContentHash, wire};
use serde::Serialize;

/// Computes the hash of a value's serialised content.
///
/// # Errors
/// If the value cannot be encoded.
pub fn content_hash(content: &impl Serialize) -> anyhow::Result<ContentHash> {
    Ok(ContentHash::of(&wire::encode(content)?))
}

/// Returns the first eight hexadecimal digits of a value's content hash, for names.
pub(crate) fn short_hash(value: &impl Serialize) -> anyhow::Result<String> {
    let hash = content_hash(value)?.to_string();
    Ok(hash.get(..8).unwrap_or_default().to_owned())
}

/// Computes the content hash of a case as hexadecimal digits.
///
/// # Errors
/// As [`content_hash`].
pub fn case_hash(case: &Case) -> anyhow::Result<String> {
    Ok(content_hash(case)?.to_string())
}
