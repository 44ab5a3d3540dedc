//! Checks that each name of a public type exists once in the product, or that its further uses stand for the
//! same idea.
use crate::banned_words::sources;
use std::{collections::BTreeMap, ffi::OsStr, fs, path::Path};
use syn::{Item, Visibility};

/// Type names that several crates use for the same idea, each with its meaning. The pumping unit's parts
/// exist twice on purpose: as data that travel (`protocol`) and as the dynamics use them (`simulation`).
const SHARED: &[(&str, &str)] = &[
    ("Coefficient", "one of the ten searched coefficients"),
    ("Column", "a derivative that a simulation returns"),
    ("Crank", "the crank of a pumping unit"),
    ("Curves", "values of several channels, sample by sample"),
    ("Derivative", "a derivative of all curves by one unknown"),
    ("ElementKind", "a kind of finite element"),
    ("Failure", "why a simulation or a job did not complete"),
    ("Individual", "one set of values of the unknowns"),
    ("Machine", "a pumping unit"),
    ("Mesh", "a finite-element mesh of the head"),
    ("Observation", "a measured value; PEST's word for it, too"),
    ("Parameter", "a number that a model or an effect takes"),
    ("Place", "where in the machine an effect acts"),
    ("Prior", "what is known of an unknown beforehand"),
    ("Problem", "an error message with its remedy"),
    ("Reached", "how far a failed simulation came"),
    ("Residual", "measured less simulated values"),
    ("Rod", "the connecting rod of a pumping unit"),
    (
        "Role",
        "whether a parameter of an effect is a size or a shape",
    ),
    ("Ropes", "the ropes of a pumping unit"),
    ("RunSettings", "numerical settings of a simulation"),
    ("Shift", "a change of an unknown's value"),
    ("StressRecovery", "how gauge stress follows from the modes"),
    ("Template", "a text in which values are filled in"),
    ("Unit", "a unit of measurement"),
    (
        "Verdict",
        "how a simulation ended; in `discrepancy`, what a diagnosis concludes (the glossary has both)",
    ),
];

/// Returns whether a file belongs to the product: it lies in no folder of tests or benches.
fn is_product(file: &Path) -> bool {
    let aside = |part: &OsStr| part == "tests" || part == "benches";
    !file.iter().any(aside)
}

/// Returns the names of the types that a list of items declares with `pub`, those of inner modules included.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "other items declare no type"
)]
fn public_types(items: &[Item]) -> Vec<String> {
    let mut names = Vec::new();
    for item in items {
        let (visibility, name) = match item {
            Item::Struct(item) => (&item.vis, &item.ident),
            Item::Enum(item) => (&item.vis, &item.ident),
            Item::Trait(item) => (&item.vis, &item.ident),
            Item::Type(item) => (&item.vis, &item.ident),
            Item::Union(item) => (&item.vis, &item.ident),
            Item::Mod(module) => {
                if let Some((_, items)) = &module.content {
                    names.extend(public_types(items));
                }
                continue;
            }
            _ => continue,
        };
        if matches!(visibility, Visibility::Public(_)) {
            names.push(name.to_string());
        }
    }
    names
}

#[test]
fn a_public_type_name_has_one_meaning() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["coordinator", "protocol", "worker"];
    let mut names: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for file in folders.iter().flat_map(|part| sources(&root.join(part))) {
        let place = file.strip_prefix(&root).expect("inside");
        if !is_product(place) {
            continue;
        }
        let text = fs::read_to_string(&file).expect("readable");
        let parsed = syn::parse_file(&text).expect("Rust");
        for name in public_types(&parsed.items) {
            let places = names.entry(name).or_default();
            places.push(place.display().to_string());
        }
    }
    let shared = |name: &str| SHARED.iter().any(|(known, _)| *known == name);
    let twice = |(name, places): &(&String, &Vec<String>)| places.len() > 1 && !shared(name);
    let wrong: Vec<_> = names.iter().filter(twice).collect();
    assert!(wrong.is_empty(), "names with several meanings: {wrong:#?}");
    for (name, _) in SHARED {
        let uses = names.get(*name).map_or(0, Vec::len);
        assert!(
            uses > 1,
            "`{name}` is used {uses} times: take it off the list"
        );
    }
    assert!(names.len() > 500, "{} types are not all", names.len());
}
