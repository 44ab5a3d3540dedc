//! Gmsh meshes: read, or refused in words.
#![no_main]
use fuzz::file;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    match coordinator::case::mesh::read(&file("head.msh", bytes)) {
        Ok(mesh) => {
            let nodes = mesh.nodes_m.len();
            let solid = mesh.volumes.values().flatten();
            let flat = mesh.surfaces.values().flatten();
            assert!(solid.chain(flat).all(|node| *node < nodes));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
