//! Output of commands that are specific to the pumping unit: JSON objects and files.
pub(super) mod curves;
pub(super) mod files;
pub(super) mod head;
pub(super) mod score;
#[cfg(test)]
mod tests;
