//! The equation of an effect: the documentation of its type in its source file.

use super::blocks::paragraph;
use super::{read, root};

/// The paragraphs of the documentation of an effect, in Markdown.
pub fn equation(id: &str) -> String {
    let path = root().join("src/physics/effects").join(id).with_extension("rs");
    let file = syn::parse_file(&read(&path)).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let documented = file.items.iter().find_map(|item| match item {
        syn::Item::Struct(of) if matches!(of.vis, syn::Visibility::Public(_)) => Some(lines(&of.attrs)),
        _ => None,
    });
    let lines = documented.unwrap_or_default();
    assert!(!lines.is_empty(), "{}: expected an equation in the documentation of the effect", path.display());
    let paragraphs = lines.split(String::is_empty).filter(|lines| !lines.is_empty());
    paragraphs.map(|lines| paragraph(&lines.join(" "))).collect::<Vec<_>>().join("\n\n")
}

/// The lines of a documentation comment.
fn lines(attributes: &[syn::Attribute]) -> Vec<String> {
    let text = |attribute: &syn::Attribute| match &attribute.meta {
        syn::Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Str(text), .. }) => {
                Some(text.value().trim().to_owned())
            }
            _ => None,
        },
        _ => None,
    };
    attributes.iter().filter_map(text).collect()
}
