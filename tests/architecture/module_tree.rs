//! Modules of a crate and the names that each of them defines or imports, read from its files as `rustc`
//! would find them. Names are not resolved to types, and dependency cycles are not considered here.
use crate::imports::{Path, Visitor};
use std::{
    collections::BTreeMap,
    path::{Path as FilePath, PathBuf},
};
use syn::{Item, UseTree, visit::Visit};

/// Meaning of a name in a module.
#[derive(Clone, Debug)]
pub(crate) enum Name {
    /// Item defined in the module's own file.
    Defined,
    /// Child module, by its index in [`ModuleTree::modules`].
    Module(usize),
    /// Import of a path, as seen from the module.
    Imported(Path),
}

/// Module of a crate with the names it defines or imports and the paths it uses.
#[derive(Debug)]
pub(crate) struct Module {
    /// Index of the file that contains the module.
    pub file: usize,
    /// Index of the parent module; `None` for the crate root.
    pub parent: Option<usize>,
    /// Names defined or imported, each with its meanings (a name may be a type and a function).
    pub names: BTreeMap<String, Vec<Name>>,
    /// Paths of the module's glob imports.
    pub globs: Vec<Path>,
    /// Every path written in the module's code, also in its imports.
    pub paths: Vec<Path>,
}

/// Files and modules of a crate.
#[derive(Debug, Default)]
pub(crate) struct ModuleTree {
    /// Paths of the crate's files, the crate root first.
    pub files: Vec<PathBuf>,
    /// Modules of the crate, the root module first.
    pub modules: Vec<Module>,
}

impl ModuleTree {
    /// Reads a crate from its root file.
    ///
    /// # Panics
    /// If a file cannot be read or parsed; such a crate would not compile either.
    pub(crate) fn read(root: &FilePath) -> Self {
        let mut tree = Self::default();
        let folder = root.parent().expect("a folder");
        tree.read_file(root, None, folder);
        tree
    }

    /// Reads a file as a module whose children lie in `folder`, and returns its index.
    fn read_file(&mut self, file: &FilePath, parent: Option<usize>, folder: &FilePath) -> usize {
        let text = std::fs::read_to_string(file)
            .unwrap_or_else(|problem| panic!("{}: {problem}", file.display()));
        let parsed = syn::parse_file(&text)
            .unwrap_or_else(|problem| panic!("{}: {problem}", file.display()));
        self.files.push(file.to_owned());
        self.module(self.files.len() - 1, parent, &parsed.items, folder)
    }

    fn module(
        &mut self,
        file: usize,
        parent: Option<usize>,
        items: &[Item],
        folder: &FilePath,
    ) -> usize {
        let index = self.modules.len();
        self.modules.push(Module {
            file,
            parent,
            names: BTreeMap::new(),
            globs: Vec::new(),
            paths: Vec::new(),
        });
        for item in items {
            if let Item::Mod(child) = item {
                let name = child.ident.to_string();
                let inside = folder.join(&name);
                let child = match &child.content {
                    Some((_, items)) => self.module(file, Some(index), items, &inside),
                    None => self.child(index, folder, (&name, path_attribute(&child.attrs))),
                };
                self.define(index, name, Name::Module(child));
            } else if let Some(name) = defined(item) {
                self.define(index, name, Name::Defined);
            }
        }
        let mut seen = Visitor::default();
        for item in items.iter().filter(|item| !matches!(item, Item::Mod(_))) {
            seen.visit_item(item);
        }
        for tree in &seen.uses {
            self.take(index, tree, &Vec::new());
        }
        self.modules[index].paths.extend(seen.paths);
        index
    }

    fn child(&mut self, parent: usize, folder: &FilePath, named: (&str, Option<String>)) -> usize {
        let (name, stated) = named;
        if let Some(stated) = stated {
            let beside = self.files[self.modules[parent].file].parent();
            let file = beside.expect("a folder").join(stated);
            let folder = file.parent().expect("a folder").to_owned();
            return self.read_file(&file, Some(parent), &folder);
        }
        let inside = folder.join(name);
        let flat = folder.join(format!("{name}.rs"));
        let file = if flat.exists() {
            flat
        } else {
            inside.join("mod.rs")
        };
        self.read_file(&file, Some(parent), &inside)
    }

    fn define(&mut self, module: usize, name: String, what: Name) {
        let names = &mut self.modules[module].names;
        names.entry(name).or_default().push(what);
    }

    /// Adds the names of a `use` tree to a module.
    fn take(&mut self, module: usize, tree: &UseTree, before: &Path) {
        let with = |ident: &syn::Ident| {
            let mut path = before.clone();
            path.push(ident.to_string());
            path
        };
        match tree {
            UseTree::Path(inner) => self.take(module, &inner.tree, &with(&inner.ident)),
            UseTree::Group(group) => {
                for tree in &group.items {
                    self.take(module, tree, before);
                }
            }
            UseTree::Glob(_) => self.modules[module].globs.push(before.clone()),
            UseTree::Name(name) if name.ident == "self" => {
                self.import(
                    module,
                    before.last().cloned().unwrap_or_default(),
                    before.clone(),
                );
            }
            UseTree::Name(name) => self.import(module, name.ident.to_string(), with(&name.ident)),
            UseTree::Rename(renamed) => {
                let path = if renamed.ident == "self" {
                    before.clone()
                } else {
                    with(&renamed.ident)
                };
                self.import(module, renamed.rename.to_string(), path);
            }
        }
    }

    fn import(&mut self, module: usize, name: String, path: Path) {
        self.modules[module].paths.push(path.clone());
        self.define(module, name, Name::Imported(path));
    }
}

/// Returns the name that an item defines, if any.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the syntax of the language is open: what is not listed names no file"
)]
fn defined(item: &Item) -> Option<String> {
    let ident = match item {
        Item::Const(item) => &item.ident,
        Item::Enum(item) => &item.ident,
        Item::Fn(item) => &item.sig.ident,
        Item::Macro(item) => item.ident.as_ref()?,
        Item::Static(item) => &item.ident,
        Item::Struct(item) => &item.ident,
        Item::Trait(item) => &item.ident,
        Item::TraitAlias(item) => &item.ident,
        Item::Type(item) => &item.ident,
        Item::Union(item) => &item.ident,
        _ => return None,
    };
    Some(ident.to_string())
}

/// Returns the value of the attribute `#[path = ".."]`.
#[expect(
    clippy::wildcard_enum_match_arm,
    reason = "the syntax of the language is open: what is not listed names no file"
)]
fn path_attribute(attributes: &[syn::Attribute]) -> Option<String> {
    let stated = attributes.iter().find(|a| a.path().is_ident("path"))?;
    let syn::Expr::Lit(literal) = &stated.meta.require_name_value().ok()?.value else {
        return None;
    };
    match &literal.lit {
        syn::Lit::Str(text) => Some(text.value()),
        _ => None,
    }
}
