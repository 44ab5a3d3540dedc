//! Collection of every path written in a piece of code: in imports, types and expressions, inside macro
//! calls, and as text in attributes such as serde's. Paths are not resolved here.
use proc_macro2::{TokenStream, TokenTree};
use syn::{UseTree, visit::Visit};

pub(crate) type Path = Vec<String>;

/// Syntax-tree visitor that collects paths and imports.
#[derive(Debug, Default)]
pub(crate) struct Visitor {
    /// Paths written in the visited code outside of `use` declarations.
    pub paths: Vec<Path>,
    /// Trees of the `use` declarations in the visited code.
    pub uses: Vec<UseTree>,
}

impl<'ast> Visit<'ast> for Visitor {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.leading_colon.is_none() {
            let segments = path
                .segments
                .iter()
                .map(|segment| segment.ident.to_string());
            self.paths.push(segments.collect());
        }
        syn::visit::visit_path(self, path);
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        if item.leading_colon.is_none() {
            self.uses.push(item.tree.clone());
        }
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.paths_of(call.tokens.clone());
        syn::visit::visit_macro(self, call);
    }

    fn visit_item_macro(&mut self, item: &'ast syn::ItemMacro) {
        self.paths_of(item.mac.tokens.clone());
        syn::visit::visit_item_macro(self, item);
    }

    // derives and lints name no file of ours, but serde's `with` and `default` are paths in text
    fn visit_attribute(&mut self, attribute: &'ast syn::Attribute) {
        if let (false, syn::Meta::List(list)) = (attribute.path().is_ident("doc"), &attribute.meta)
        {
            self.texts_of(list.tokens.clone());
        }
    }

    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {}
}

impl Visitor {
    /// Collects the paths in the tokens of a macro call: identifiers joined by `::`, except those after a
    /// dot.
    fn paths_of(&mut self, tokens: TokenStream) {
        let mut path = Path::new();
        let (mut colons, mut dot) = (0, false);
        for token in tokens {
            match token {
                TokenTree::Ident(ident) if !dot => {
                    if colons != 2 {
                        self.paths.push(std::mem::take(&mut path));
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                TokenTree::Punct(punct) if punct.as_char() == ':' => colons += 1,
                TokenTree::Punct(punct) => {
                    self.paths.push(std::mem::take(&mut path));
                    (colons, dot) = (0, punct.as_char() == '.');
                    continue;
                }
                TokenTree::Group(group) => {
                    self.paths.push(std::mem::take(&mut path));
                    self.paths_of(group.stream());
                }
                TokenTree::Ident(_) | TokenTree::Literal(_) => {
                    self.paths.push(std::mem::take(&mut path));
                }
            }
            dot = false;
        }
        self.paths.push(path);
        self.paths.retain(|path| !path.is_empty());
    }

    /// Collects the paths written as string literals in the tokens of an attribute.
    fn texts_of(&mut self, tokens: TokenStream) {
        for token in tokens {
            match token {
                TokenTree::Group(group) => self.texts_of(group.stream()),
                TokenTree::Literal(literal) => {
                    let text = literal.to_string();
                    if let Ok(path) = syn::parse_str::<syn::Path>(text.trim_matches('"')) {
                        self.visit_path(&path);
                    }
                }
                TokenTree::Ident(_) | TokenTree::Punct(_) => {}
            }
        }
    }
}
