//! Which file of `src/` names an item of which other one, re-exports followed to where the item is defined.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};

/// A module, in a file of its own or inline.
#[derive(Default)]
struct Module {
    parent: Option<usize>,
    file: usize,
    children: BTreeMap<String, usize>,
    items: BTreeSet<String>,
    uses: Vec<Use>,
    /// paths that the code names
    paths: Vec<Vec<String>>,
}

/// One name that a `use` brings in.
struct Use {
    /// the name here; `*` for all of them
    name: String,
    path: Vec<String>,
    is_exported: bool,
}

/// Files and who imports whom.
pub struct Graph {
    /// from `src`, with `/`
    pub files: Vec<String>,
    /// indices of the files that a file imports
    pub imports: Vec<BTreeSet<usize>>,
}

impl Graph {
    /// Of the library or the binary that begins with this file of `src/`.
    pub fn of(src: &Path, root: &str) -> Self {
        let mut reader = Reader { files: Vec::new(), modules: Vec::new() };
        reader.file(src, Path::new(root), None);
        let Reader { files, modules } = reader;
        let mut imports = vec![BTreeSet::new(); files.len()];
        for (at, module) in modules.iter().enumerate() {
            let own = module.uses.iter().filter(|import| !import.is_exported).map(|import| &import.path);
            for path in own.chain(&module.paths) {
                if let Some(file) = resolve(&modules, at, path, 0)
                    && file != module.file
                {
                    imports[module.file].insert(file);
                }
            }
        }
        Self { files, imports }
    }

    /// Groups of files in which each reaches each other by imports, the greatest first.
    pub fn circles(&self) -> Vec<Vec<&str>> {
        let reach: Vec<BTreeSet<usize>> = (0..self.files.len()).map(|file| self.reach(file)).collect();
        let mut seen = BTreeSet::new();
        let mut circles = Vec::new();
        for file in 0..self.files.len() {
            if !seen.insert(file) || !reach[file].contains(&file) {
                continue;
            }
            let circle: Vec<usize> =
                reach[file].iter().copied().filter(|to| reach[*to].contains(&file)).collect();
            seen.extend(&circle);
            circles.push(circle.iter().map(|file| self.files[*file].as_str()).collect::<Vec<_>>());
        }
        circles.sort_by_key(|circle| std::cmp::Reverse(circle.len()));
        circles
    }

    fn reach(&self, from: usize) -> BTreeSet<usize> {
        let mut reached = BTreeSet::new();
        let mut open = vec![from];
        while let Some(file) = open.pop() {
            open.extend(self.imports[file].iter().filter(|to| reached.insert(**to)));
        }
        reached
    }
}

struct Reader {
    files: Vec<String>,
    modules: Vec<Module>,
}

impl Reader {
    fn file(&mut self, src: &Path, path: &Path, parent: Option<usize>) -> usize {
        let text = std::fs::read_to_string(src.join(path)).unwrap();
        let parsed = syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        self.files.push(path.to_str().unwrap().replace('\\', "/"));
        // `a/mod.rs`, `lib.rs` and `main.rs` hold the modules of their own folder
        let stem = path.file_stem().unwrap().to_str().unwrap();
        let folder = path.parent().unwrap();
        let folder =
            if ["mod", "lib", "main"].contains(&stem) { folder.to_owned() } else { folder.join(stem) };
        self.module(src, &folder, self.files.len() - 1, parent, &parsed.items)
    }

    fn module(
        &mut self,
        src: &Path,
        folder: &Path,
        file: usize,
        parent: Option<usize>,
        items: &[syn::Item],
    ) -> usize {
        let at = self.modules.len();
        self.modules.push(Module { parent, file, ..Module::default() });
        for item in items {
            if is_test(item) {
                continue;
            }
            match item {
                syn::Item::Mod(inner) => {
                    let name = inner.ident.to_string();
                    let child = if let Some((_, items)) = &inner.content {
                        self.module(src, &folder.join(&name), file, Some(at), items)
                    } else {
                        let [flat, deep] =
                            [format!("{name}.rs"), format!("{name}/mod.rs")].map(|end| folder.join(end));
                        self.file(src, if src.join(&flat).exists() { &flat } else { &deep }, Some(at))
                    };
                    self.modules[at].children.insert(name, child);
                }
                syn::Item::Use(item) => {
                    let is_exported = !matches!(item.vis, syn::Visibility::Inherited);
                    flatten(&item.tree, &mut Vec::new(), is_exported, &mut self.modules[at].uses);
                }
                other => {
                    self.modules[at].items.extend(name_of(other));
                    self.modules[at].items.extend(struct_in(other));
                    let mut paths = Paths(Vec::new());
                    paths.visit_item(other);
                    self.modules[at].paths.append(&mut paths.0);
                }
            }
        }
        at
    }
}

fn is_test(item: &syn::Item) -> bool {
    let attributes = match item {
        syn::Item::Mod(item) => &item.attrs,
        syn::Item::Fn(item) => &item.attrs,
        syn::Item::Use(item) => &item.attrs,
        syn::Item::Impl(item) => &item.attrs,
        syn::Item::Struct(item) => &item.attrs,
        syn::Item::Const(item) => &item.attrs,
        _ => return false,
    };
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::List(list) if list.path.is_ident("cfg") => list.tokens.to_string() == "test",
        _ => false,
    })
}

fn name_of(item: &syn::Item) -> Option<String> {
    Some(match item {
        syn::Item::Const(item) => item.ident.to_string(),
        syn::Item::Enum(item) => item.ident.to_string(),
        syn::Item::Fn(item) => item.sig.ident.to_string(),
        syn::Item::Static(item) => item.ident.to_string(),
        syn::Item::Struct(item) => item.ident.to_string(),
        syn::Item::Trait(item) => item.ident.to_string(),
        syn::Item::Type(item) => item.ident.to_string(),
        syn::Item::Union(item) => item.ident.to_string(),
        syn::Item::Macro(item) => item.ident.as_ref()?.to_string(),
        _ => return None,
    })
}

/// The structure that a macro defines as it was written.
fn struct_in(item: &syn::Item) -> Option<String> {
    let syn::Item::Macro(item) = item else { return None };
    let mut tokens = item.mac.tokens.clone().into_iter();
    tokens.find(|token| token.to_string() == "struct")?;
    tokens.next().map(|name| name.to_string())
}

fn flatten(tree: &syn::UseTree, before: &mut Vec<String>, is_exported: bool, into: &mut Vec<Use>) {
    let mut push = |name: String, last: Option<String>| {
        let mut path = before.clone();
        path.extend(last);
        into.push(Use { name, path, is_exported });
    };
    match tree {
        syn::UseTree::Path(path) => {
            before.push(path.ident.to_string());
            flatten(&path.tree, before, is_exported, into);
            before.pop();
        }
        syn::UseTree::Name(name) if name.ident == "self" => {
            push(before.last().cloned().unwrap_or_default(), None);
        }
        syn::UseTree::Name(name) => push(name.ident.to_string(), Some(name.ident.to_string())),
        syn::UseTree::Rename(name) => push(name.rename.to_string(), Some(name.ident.to_string())),
        syn::UseTree::Glob(_) => push("*".to_owned(), None),
        syn::UseTree::Group(group) => {
            for tree in &group.items {
                flatten(tree, before, is_exported, into);
            }
        }
    }
}

/// All paths of an item, those in macros among them.
struct Paths(Vec<Vec<String>>);

impl<'ast> Visit<'ast> for Paths {
    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.tokens(call.tokens.clone());
        visit::visit_macro(self, call);
    }
}

impl Paths {
    fn tokens(&mut self, tokens: TokenStream) {
        let mut path: Vec<String> = Vec::new();
        let mut colons = 0;
        for token in tokens {
            match token {
                TokenTree::Ident(name) if colons == 2 || path.is_empty() => {
                    path.push(name.to_string());
                    colons = 0;
                }
                TokenTree::Punct(mark) if mark.as_char() == ':' && !path.is_empty() && colons < 2 => {
                    colons += 1
                }
                other => {
                    self.0.extend((!path.is_empty()).then(|| std::mem::take(&mut path)));
                    colons = 0;
                    match other {
                        TokenTree::Ident(name) => path.push(name.to_string()),
                        TokenTree::Group(group) => self.tokens(group.stream()),
                        _ => {}
                    }
                }
            }
        }
        self.0.extend((!path.is_empty()).then_some(path));
    }
}

/// The file that defines what a path names in a module, if it is one of ours.
fn resolve(modules: &[Module], at: usize, path: &[String], depth: usize) -> Option<usize> {
    // re-exports of re-exports end somewhere
    if depth > 16 {
        return None;
    }
    let (first, rest) = path.split_first()?;
    let next = match first.as_str() {
        "crate" => {
            let mut root = at;
            while let Some(parent) = modules[root].parent {
                root = parent;
            }
            root
        }
        "self" => at,
        "super" => modules[at].parent?,
        name => return named(modules, at, name, rest, depth),
    };
    if rest.is_empty() { Some(modules[next].file) } else { resolve_in(modules, next, rest, depth) }
}

/// As [`resolve`], of a path in which no outer crate can be meant.
fn resolve_in(modules: &[Module], at: usize, path: &[String], depth: usize) -> Option<usize> {
    match path.split_first()? {
        (first, _) if first == "super" => resolve(modules, at, path, depth),
        (first, rest) => named(modules, at, first, rest, depth),
    }
}

fn named(modules: &[Module], at: usize, name: &str, rest: &[String], depth: usize) -> Option<usize> {
    let module = &modules[at];
    if let Some(child) = module.children.get(name) {
        return if rest.is_empty() {
            // a module alone says nothing of what is taken from it
            None
        } else {
            resolve_in(modules, *child, rest, depth)
        };
    }
    if module.items.contains(name) {
        return Some(module.file);
    }
    for import in &module.uses {
        if import.name == name {
            let whole: Vec<String> = import.path.iter().chain(rest).cloned().collect();
            // `use std::fmt; fmt::x` is somebody else's
            return (whole[0] != name || import.path.len() > 1)
                .then(|| resolve(modules, at, &whole, depth + 1))
                .flatten();
        }
    }
    module.uses.iter().filter(|import| import.name == "*" && depth < 8).find_map(|import| {
        let whole: Vec<String> =
            import.path.iter().cloned().chain([name.to_owned()]).chain(rest.iter().cloned()).collect();
        resolve(modules, at, &whole, depth + 4)
    })
}
