//! Fuzz target: the reader of Gmsh meshes.
#![no_main]
use fuzz::{FOLDER, property::file::is_a_mesh_or_refused};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| is_a_mesh_or_refused(&FOLDER, bytes));
