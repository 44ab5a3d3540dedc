//! The properties that decoders must keep, whatever bytes they get: what the targets try a million times
//! and the suites of `protocol` and `coordinator` a few hundred.
pub mod file;
pub mod wire;
