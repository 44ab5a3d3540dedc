//! Documentation required of every effect in the library.

/// Checks that the module documentation of every effect states the source of its law.
#[test]
fn every_effect_names_its_source() {
    let manifest = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let effects = manifest.join("../../worker/simulation/src/effect/named");
    let mut laws = 0;
    for file in std::fs::read_dir(effects).unwrap() {
        let path = file.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        if text.contains("fn descriptor() -> Descriptor") {
            laws += 1;
            assert!(text.contains("\n//! Source: "), "{}", path.display());
        }
    }
    assert!(laws >= 24, "{laws}");
}
