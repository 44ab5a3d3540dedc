//! Properties that decoders must keep for arbitrary bytes. The fuzz targets test them on millions of inputs,
//! the test suites of `protocol` and `coordinator` on a few hundred.
pub mod file;
pub mod wire;
