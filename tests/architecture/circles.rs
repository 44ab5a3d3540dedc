//! Circular dependencies between the files and between the folders of a crate, read from its `use` lines and from the
//! paths in its code that begin with `crate` or `super`.
//!
//! A file depends on the file that defines what it names, also through re-imports. A folder depends on another folder, or
//! on a file beside it, where one of its files does. A folder and the files in it are no circle, and tests may name
//! everything.
//!
//! Not seen: names that come through a glob import, `super` within an inline module, and modules under another name.
use crate::{
    banned_words::sources,
    workspace::{packages, targets},
};
use std::{
    collections::{BTreeMap, BTreeSet},
    fs,
    path::{Path, PathBuf},
};

/// Dependencies between names: user, used.
type Edges = BTreeSet<(String, String)>;

/// Largest number of re-imports followed to the file that defines a name.
const DEEPEST: usize = 8;

/// File of a crate with the paths that it names.
struct Source {
    /// Path of the file below the crate's root folder.
    file: String,
    /// Paths that the file names, each segment by segment from the crate's root.
    paths: Vec<Vec<String>>,
    /// Names that the file re-imports, each with its path.
    imports: BTreeMap<String, Vec<String>>,
}

/// Splits the tree of a `use` line into its paths, with `name as other` as their last segments.
fn branches(tree: &str) -> Vec<String> {
    let Some((before, rest)) = tree.split_once('{') else {
        return vec![tree.trim().to_owned()];
    };
    let inside = rest.rsplit_once('}').map_or(rest, |(inside, _)| inside);
    let (mut parts, mut depth) = (vec![String::new()], 0);
    for letter in inside.chars() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        match (letter, depth) {
            (',', 0) => parts.push(String::new()),
            _ => parts.last_mut().expect("a part").push(letter),
        }
    }
    let parts = parts.iter().filter(|part| !part.trim().is_empty());
    parts
        .flat_map(|part| branches(part))
        .map(|path| before.trim().to_owned() + &path)
        .collect()
}

/// Returns the code of a file without comments and without the tests at its end.
fn code(text: &str) -> String {
    let product = text.split("#[cfg(test)]\nmod tests {").next();
    let lines = product.unwrap_or_default().lines();
    let code = lines.map(|line| line.split("//").next().unwrap_or_default());
    code.collect::<Vec<_>>().join("\n")
}

/// Returns the paths from the crate's root for a path that the module `inside` names; none for one into another crate.
fn absolute(inside: &[String], path: &str, modules: &BTreeSet<Vec<String>>) -> Option<Vec<String>> {
    let mut rest: Vec<String> = path
        .split("::")
        .map(|part| part.trim().to_owned())
        .collect();
    let mut base = inside.to_vec();
    match rest.first()?.as_str() {
        "crate" => base.clear(),
        "self" => {}
        "super" => {
            base.pop();
            while rest.get(1).is_some_and(|next| next == "super") {
                base.pop();
                rest.remove(0);
            }
        }
        first => {
            let child = [inside, &[first.to_owned()]].concat();
            return modules.contains(&child).then(|| [inside, &rest].concat());
        }
    }
    rest.remove(0);
    Some([base, rest].concat())
}

/// Returns the module that a file is, by its path below the crate's root folder.
fn module(file: &str) -> Vec<String> {
    let mut parts: Vec<String> = file
        .trim_end_matches(".rs")
        .split('/')
        .map(str::to_owned)
        .collect();
    if parts
        .last()
        .is_some_and(|last| ["mod", "lib", "main"].contains(&last.as_str()))
    {
        parts.pop();
    }
    parts
}

/// Removes the modules to which `pub(in ...)` limits items: they are named, and nothing of them is used.
fn without_visibilities(code: &str) -> String {
    let mut parts = code.split("(in ");
    let first = parts.next().unwrap_or_default().to_owned();
    let rest = parts.map(|part| part.split_once(')').map_or(part, |(_, rest)| rest));
    first + &rest.collect::<String>()
}

/// Splits a statement into what stands before its `use` tree, and that tree; none if it is no `use` statement.
fn use_tree(statement: &str) -> (&str, Option<&str>) {
    let split = statement.rsplit_once("use ").filter(|(before, _)| {
        let last = before.rsplit([';', '{', '}', ']']).next();
        let last = last.unwrap_or_default().trim();
        last.is_empty() || last.starts_with("pub")
    });
    split.map_or((statement, None), |(before, tree)| (before, Some(tree)))
}

fn read(file: &str, text: &str, modules: &BTreeSet<Vec<String>>) -> Source {
    let code = without_visibilities(&code(text));
    let (own, mut paths, mut imports) = (module(file), Vec::new(), BTreeMap::new());
    for statement in code.split(';') {
        let (before, tree) = use_tree(statement);
        for path in tree.into_iter().flat_map(branches) {
            let (path, name) = path.split_once(" as ").unwrap_or((&path, ""));
            let Some(path) = absolute(&own, path, modules) else {
                continue;
            };
            let mut path = path;
            let is_glob = path.last().is_some_and(|last| last == "*");
            if is_glob || path.last().is_some_and(|last| last == "self") {
                path.pop();
            }
            let last = path.last().map_or("", String::as_str);
            let name = if name.is_empty() { last } else { name.trim() };
            if !is_glob {
                imports.insert(name.to_owned(), path.clone());
            }
            paths.push(path);
        }
        let is_path = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
        for word in before.split(|letter: char| !is_path(letter)) {
            if word.contains("::") {
                paths.extend(absolute(&own, word, modules));
            }
        }
    }
    Source {
        file: file.to_owned(),
        paths,
        imports,
    }
}

/// Returns the file that defines what a path names.
fn defining(
    path: &[String],
    sources: &BTreeMap<Vec<String>, Source>,
    deepest: usize,
) -> Option<String> {
    let mut longest = (0..=path.len()).rev();
    let (source, rest) =
        longest.find_map(|end| Some((sources.get(path.get(..end)?)?, path.get(end..)?)))?;
    let import = rest.first().and_then(|name| source.imports.get(name));
    match (import, deepest.checked_sub(1)) {
        (Some(import), Some(deepest)) => {
            let path = [import, rest.get(1..).unwrap_or_default()].concat();
            defining(&path, sources, deepest)
        }
        _ => Some(source.file.clone()),
    }
}

/// Returns whether a file holds nothing but tests.
fn is_test(file: &str) -> bool {
    file.ends_with("tests.rs") || file.contains("tests/")
}

/// Returns the dependencies between the files of a crate, given their paths below its root folder with their texts.
fn dependencies(files: &[(String, String)]) -> Edges {
    let files = files.iter().filter(|(file, _)| !is_test(file));
    let modules: BTreeSet<Vec<String>> = files.clone().map(|(file, _)| module(file)).collect();
    let sources: BTreeMap<Vec<String>, Source> = files
        .map(|(file, text)| (module(file), read(file, text, &modules)))
        .collect();
    let mut edges = Edges::new();
    for source in sources.values() {
        for path in &source.paths {
            let used = defining(path, &sources, DEEPEST);
            edges.extend(
                used.filter(|used| *used != source.file)
                    .map(|used| (source.file.clone(), used)),
            );
        }
    }
    edges
}

/// Returns the dependencies between folders, and between a folder and a file beside it.
fn between_folders(files: &Edges) -> Edges {
    let mut edges = Edges::new();
    for (user, used) in files {
        let (user, used): (Vec<&str>, Vec<&str>) =
            (user.split('/').collect(), used.split('/').collect());
        let common = user
            .iter()
            .zip(&used)
            .take_while(|(one, other)| one == other)
            .count();
        let beside = |file: &[&str]| {
            let name = file.get(common)?.trim_end_matches(".rs");
            let is_parent = ["mod", "lib", "main"].contains(&name);
            let path = [file.get(..common)?, &[name]].concat().join("/");
            (!is_parent).then_some(path)
        };
        if let (Some(user), Some(used)) = (beside(&user), beside(&used))
            && user != used
        {
            edges.insert((user, used));
        }
    }
    edges
}

/// Returns the circular dependencies: names of which each depends on all others.
fn circles(edges: &Edges) -> BTreeSet<BTreeSet<String>> {
    let reachable = |from: &String| {
        let (mut seen, mut ahead) = (BTreeSet::new(), vec![from]);
        while let Some(name) = ahead.pop() {
            for (_, used) in edges.iter().filter(|(user, _)| user == name) {
                if seen.insert(used.clone()) {
                    ahead.push(used);
                }
            }
        }
        seen
    };
    let names: BTreeSet<&String> = edges.iter().map(|(user, _)| user).collect();
    let reach: BTreeMap<&String, BTreeSet<String>> = names
        .into_iter()
        .map(|name| (name, reachable(name)))
        .collect();
    let tied = |(name, all): (&&String, &BTreeSet<String>)| -> BTreeSet<String> {
        let back = |other: &&String| reach.get(other).is_some_and(|all| all.contains(*name));
        all.iter().filter(back).cloned().collect()
    };
    reach
        .iter()
        .map(tied)
        .filter(|circle| circle.len() > 1)
        .collect()
}

/// Describes the circles of files and of folders, each with the dependencies between files that make it.
fn described(files: &Edges) -> String {
    let all = [circles(files), circles(&between_folders(files))];
    let describe = |circle: &BTreeSet<String>| {
        let is_in = |file: &str| {
            let mut names = circle.iter();
            names.any(|name| {
                file.strip_prefix(name.as_str())
                    .is_some_and(|rest| ["", ".rs"].contains(&rest) || rest.starts_with('/'))
            })
        };
        let edges = files
            .iter()
            .filter(|(user, used)| is_in(user) && is_in(used));
        let edges: Vec<String> = edges
            .map(|(user, used)| format!("  {user} -> {used}\n"))
            .collect();
        let edges = edges.concat();
        let names: Vec<&str> = circle.iter().map(String::as_str).collect();
        format!("a circle of {}:\n{edges}", names.join(", "))
    };
    all.iter().flatten().map(describe).collect()
}

/// Returns the files below the folder of a crate's root file, with their texts.
fn files(root: &Path) -> Vec<(String, String)> {
    let folder = root.parent().expect("a folder");
    // a program beside a library is another crate, which names the library by its name
    let other = if root.ends_with("lib.rs") {
        "main.rs"
    } else {
        "lib.rs"
    };
    let own = sources(folder).into_iter();
    let own = own.filter(|path| *path != folder.join(other));
    let all = own.map(|path| {
        let name = path
            .strip_prefix(folder)
            .expect("inside")
            .display()
            .to_string();
        (name, fs::read_to_string(&path).expect("readable"))
    });
    all.collect()
}

#[test]
fn no_circles_of_files_or_folders() {
    let (mut words, mut count) = (String::new(), 0);
    let roots: BTreeSet<PathBuf> = packages()
        .iter()
        .flat_map(targets)
        .map(|(_, root)| root)
        .collect();
    for root in roots
        .iter()
        .filter(|root| root.ends_with("lib.rs") || root.ends_with("main.rs"))
    {
        let edges = dependencies(&files(root));
        count += edges.len();
        let found = described(&edges);
        if !found.is_empty() {
            words = words + &root.display().to_string() + ": " + &found;
        }
    }
    assert!(count > 1000, "only {count} dependencies were found");
    assert!(words.is_empty(), "\n{words}");
}

/// Returns the circles of files, and those of folders, of a crate made of the given files (name, text).
fn circles_of(files: &[(&str, &str)]) -> [Vec<String>; 2] {
    let files: Vec<_> = files
        .iter()
        .map(|(name, text)| ((*name).to_owned(), (*text).to_owned()))
        .collect();
    let edges = dependencies(&files);
    [circles(&edges), circles(&between_folders(&edges))].map(|all| {
        let words = all
            .iter()
            .map(|circle| circle.iter().cloned().collect::<Vec<_>>().join(" "));
        words.collect()
    })
}

#[test]
fn circles_are_found_through_imports_paths_and_re_exports() {
    let none = Vec::<String>::new();
    let files = [
        ("lib.rs", "mod a; mod b;"),
        ("a.rs", "use crate::b::B; pub struct A(B);"),
        ("b.rs", "pub struct B; fn f(_: &crate::a::A) {}"),
    ];
    assert_eq!(
        circles_of(&files),
        [vec!["a.rs b.rs".to_owned()], vec!["a b".to_owned()]]
    );
    let through = [
        ("lib.rs", "mod a; mod b; mod c;"),
        ("a.rs", "pub use crate::b::B as Other;"),
        ("b.rs", "use crate::{c::{self, C}}; pub struct B(C);"),
        ("c.rs", "use super::a::Other; pub struct C;"),
    ];
    assert_eq!(circles_of(&through)[0], ["b.rs c.rs"]);
    let parent = [
        ("lib.rs", "mod p;"),
        ("p/mod.rs", "mod c; pub use c::C; pub trait T {}"),
        ("p/c.rs", "use super::T; pub struct C; impl T for C {}"),
    ];
    assert_eq!(
        circles_of(&parent),
        [vec!["p/c.rs p/mod.rs".to_owned()], none.clone()]
    );
    let re_exported = [
        ("lib.rs", "mod p;"),
        ("p/mod.rs", "mod c; mod t; pub use c::C; pub use t::T;"),
        ("p/c.rs", "use super::T; pub struct C; impl T for C {}"),
        ("p/t.rs", "pub trait T {}"),
        ("p/tests.rs", "use super::*; use crate::p::c;"),
    ];
    assert_eq!(circles_of(&re_exported), [none.clone(), none]);
}

#[test]
fn folders_whose_files_name_each_other_are_a_circle() {
    let files = [
        ("lib.rs", "mod a; mod b;"),
        ("a/mod.rs", "pub mod one; pub mod two;"),
        ("a/one.rs", "use crate::b::one::B;"),
        ("a/two.rs", "pub struct A;"),
        ("b/mod.rs", "pub mod one; pub mod two;"),
        ("b/one.rs", "pub struct B;"),
        ("b/two.rs", "use crate::a::two::A;"),
    ];
    assert_eq!(circles_of(&files), [Vec::new(), vec!["a b".to_owned()]]);
}
