//! Checks that no crate of the workspace has a dependency cycle between its files, and that the detector
//! finds cycles in small examples.
use crate::{
    cycle::{circles, in_words, uses},
    module_tree::ModuleTree,
    workspace::{packages, targets},
};
use std::{fs, path::Path};

#[test]
fn no_circles_of_files() {
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let base = base.canonicalize().expect("the workspace");
    let (mut words, mut files) = (String::new(), 0);
    for package in &packages() {
        for (target, root) in targets(package) {
            let tree = ModuleTree::read(&root);
            let uses = uses(&tree);
            files += tree.files.len();
            for circle in circles(tree.files.len(), &uses) {
                words = words + &target + ": " + &in_words(&tree, &uses, &circle, &base);
            }
        }
    }
    assert!(files > 400, "only {files} files were read");
    assert!(words.is_empty(), "\n{words}");
}

/// Returns the dependency cycles of a crate made of the given files (name, text).
fn circles_of(files: &[(&str, &str)]) -> Vec<Vec<String>> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    let tree = ModuleTree::read(&folder.path().join("lib.rs"));
    let name = |file: &usize| {
        let path = tree.files[*file].strip_prefix(folder.path()).unwrap();
        path.display().to_string()
    };
    let found = circles(tree.files.len(), &uses(&tree));
    found
        .iter()
        .map(|set| set.iter().map(name).collect())
        .collect()
}

const NONE: Vec<Vec<String>> = Vec::new();

fn one(files: &[&str]) -> Vec<Vec<String>> {
    vec![files.iter().map(|&name| name.to_owned()).collect()]
}

#[test]
fn two_files_that_import_each_other() {
    let files = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::B; pub struct A(B);"),
        ("b.rs", "pub struct B; fn f(_: &crate::a::A) {}"),
    ];
    assert_eq!(circles_of(&files), one(&["a.rs", "b.rs"]));
}

#[test]
fn a_re_export_leads_to_the_file_that_defines() {
    let files = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "pub use crate::b::B; pub struct A;"),
        ("b.rs", "use crate::c; pub struct B; fn f() { c::f() }"),
        ("c.rs", "use crate::a::B; pub fn f() {}"),
    ];
    assert_eq!(circles_of(&files), one(&["b.rs", "c.rs"]));
}

#[test]
fn a_parent_and_its_child_are_two_files() {
    let tied = [
        ("lib.rs", "mod p;"),
        ("p/mod.rs", "mod c; pub use c::C; pub trait T {}"),
        ("p/c.rs", "use super::T; pub struct C; impl T for C {}"),
    ];
    assert_eq!(circles_of(&tied), one(&["p/mod.rs", "p/c.rs"]));
    let declared = [
        ("lib.rs", "mod p;"),
        ("p.rs", "#[cfg(test)] mod tests; pub struct P;"),
        ("p/tests.rs", "use super::*; fn f(_: P) {}"),
    ];
    assert_eq!(circles_of(&declared), NONE);
}

#[test]
fn re_exports_that_nobody_below_takes_back_are_no_circle() {
    let files = [
        ("lib.rs", "mod p;"),
        ("p/mod.rs", "mod c; mod t; pub use c::C; pub use t::T;"),
        ("p/c.rs", "use super::T; pub struct C; impl T for C {}"),
        ("p/t.rs", "pub trait T {}"),
    ];
    assert_eq!(circles_of(&files), NONE);
}

#[test]
fn globs_macros_and_attributes_are_read() {
    let glob = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::*; pub struct A; fn f() { go() }"),
        (
            "b.rs",
            "pub fn go() { println!(\"{:?}\", vec![crate::a::A]) }",
        ),
    ];
    assert_eq!(circles_of(&glob), one(&["a.rs", "b.rs"]));
    let attribute = [
        ("lib.rs", "mod a; mod b;"),
        (
            "a.rs",
            "#[serde(with = \"crate::b\", default = \"crate::b::go\")] pub struct A;",
        ),
        ("b.rs", "use super::a::A; pub fn go(_: A) {}"),
    ];
    assert_eq!(circles_of(&attribute), one(&["a.rs", "b.rs"]));
    let unused = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::*; pub struct A;"),
        ("b.rs", "pub fn go(_: crate::a::A) {}"),
    ];
    assert_eq!(circles_of(&unused), NONE);
}
