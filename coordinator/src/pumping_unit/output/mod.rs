//! What the machine's own commands print and write.
pub(super) mod curves;
pub(super) mod files;
pub(super) mod head;
pub(super) mod score;
#[cfg(test)]
mod tests;
