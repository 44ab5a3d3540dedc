//! Detection of dependency cycles between the files of a crate. A file depends on every other file that
//! defines a name it uses: a name that it imports, directly or through a re-export, or writes as a path.
//! Tests count like other code, and a parent module and its child are two files; `mod child;` alone is no
//! dependency on the child.
use crate::module_tree::{ModuleTree, Name};
use std::{
    collections::{BTreeMap, BTreeSet},
    path::Path as FilePath,
};

/// Dependencies between files of a crate: file indices (user, used), each with the names taken from the used
/// file.
pub(crate) type Uses = BTreeMap<(usize, usize), BTreeSet<String>>;

/// Largest number of re-exports followed to find the definition of a name; no chain in the workspace is so
/// long.
const DEEPEST: usize = 16;

/// Returns the dependencies between the files of a crate.
pub(crate) fn uses(tree: &ModuleTree) -> Uses {
    let mut uses = Uses::new();
    for (index, module) in tree.modules.iter().enumerate() {
        for path in module.paths.iter().chain(&module.globs) {
            for (file, name) in definitions(tree, index, path) {
                if file != module.file {
                    uses.entry((module.file, file)).or_default().insert(name);
                }
            }
        }
    }
    uses
}

/// Returns the files (with item names) that define the items to which a path refers, as seen from a module.
fn definitions(tree: &ModuleTree, module: usize, path: &[String]) -> BTreeSet<(usize, String)> {
    let found = resolve(tree, module, path, DEEPEST);
    found
        .into_iter()
        .filter_map(|one| match one {
            Found::Item(file, name) => Some((file, name)),
            Found::Module(_) => None,
        })
        .collect()
}

/// Target of a path: a module, or an item by its file and name.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Found {
    Module(usize),
    Item(usize, String),
}

fn resolve(tree: &ModuleTree, module: usize, path: &[String], deepest: usize) -> BTreeSet<Found> {
    let Some((first, rest)) = path.split_first() else {
        return BTreeSet::new();
    };
    let start = match first.as_str() {
        "crate" => BTreeSet::from([Found::Module(0)]),
        "self" => BTreeSet::from([Found::Module(module)]),
        "super" => {
            let parent = tree.modules[module].parent;
            parent.into_iter().map(Found::Module).collect()
        }
        name => named(tree, module, name, deepest),
    };
    start
        .into_iter()
        .flat_map(|found| follow(tree, found, rest, deepest))
        .collect()
}

/// Resolves the remaining segments of a path from the item or module that its first segments denote.
fn follow(tree: &ModuleTree, from: Found, rest: &[String], deepest: usize) -> BTreeSet<Found> {
    let (Found::Module(module), Some((first, rest))) = (&from, rest.split_first()) else {
        return BTreeSet::from([from]);
    };
    let next = if first == "super" {
        let parent = tree.modules[*module].parent;
        parent.into_iter().map(Found::Module).collect()
    } else {
        named(tree, *module, first, deepest)
    };
    next.into_iter()
        .flat_map(|found| follow(tree, found, rest, deepest))
        .collect()
}

/// Returns the items and modules that a name denotes in a module, found through imports and re-exports.
fn named(tree: &ModuleTree, module: usize, name: &str, deepest: usize) -> BTreeSet<Found> {
    let Some(deepest) = deepest.checked_sub(1) else {
        return BTreeSet::new();
    };
    let inside = &tree.modules[module];
    if let Some(known) = inside.names.get(name) {
        let meanings = known.iter().flat_map(|meaning| match meaning {
            Name::Defined => BTreeSet::from([Found::Item(inside.file, name.to_owned())]),
            Name::Module(child) => BTreeSet::from([Found::Module(*child)]),
            // a crate of the same name as what is taken from it leads nowhere of ours
            Name::Imported(path) if path.first().is_some_and(|first| first == name) => {
                BTreeSet::new()
            }
            Name::Imported(path) => resolve(tree, module, path, deepest),
        });
        return meanings.collect();
    }
    let globs = inside.globs.iter();
    globs
        .flat_map(|path| resolve(tree, module, path, deepest))
        .flat_map(|found| match found {
            Found::Module(other) if other != module => named(tree, other, name, deepest),
            Found::Module(_) | Found::Item(..) => BTreeSet::new(),
        })
        .collect()
}

/// Returns the dependency cycles: strongly connected components of more than one file.
pub(crate) fn circles(files: usize, uses: &Uses) -> Vec<BTreeSet<usize>> {
    let mut reach: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); files];
    for (from, to) in uses.keys() {
        reach[*from].insert(*to);
    }
    let reachable = |from: usize| {
        let mut seen = BTreeSet::new();
        let mut ahead: Vec<usize> = reach[from].iter().copied().collect();
        while let Some(file) = ahead.pop() {
            if seen.insert(file) {
                ahead.extend(&reach[file]);
            }
        }
        seen
    };
    let all: Vec<BTreeSet<usize>> = (0..files).map(reachable).collect();
    let tied = |a: usize| -> BTreeSet<usize> {
        let others = all[a].iter().filter(|b| all[**b].contains(&a));
        others.copied().chain([a]).collect()
    };
    let sets: BTreeSet<BTreeSet<usize>> = (0..files).map(tied).collect();
    sets.into_iter().filter(|set| set.len() > 1).collect()
}

/// Formats a dependency cycle as text: each dependency inside it with the names taken.
pub(crate) fn in_words(
    tree: &ModuleTree,
    uses: &Uses,
    circle: &BTreeSet<usize>,
    base: &FilePath,
) -> String {
    let short = |file: usize| {
        let path = &tree.files[file];
        path.strip_prefix(base)
            .unwrap_or(path)
            .display()
            .to_string()
    };
    let mut words = format!("a circle of {} files:\n", circle.len());
    for ((from, to), names) in uses {
        if circle.contains(from) && circle.contains(to) {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let (from, to) = (short(*from), short(*to));
            words = words + "  " + &from + " -> " + &to + ": " + &names.join(", ") + "\n";
        }
    }
    words
}
