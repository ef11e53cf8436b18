//! Quotations, paths and lists of names, clean and no longer than can be read.

use std::ffi::OsStr;

use super::escape::clean;

/// Names of a list that are told one by one.
const LISTED: usize = 20;
/// Characters of one name in a list.
const NAME_CHARS: usize = 64;

/// Clean, and no longer than `chars` characters: an error need not repeat a file.
#[must_use]
pub fn excerpt(text: &str, chars: usize) -> String {
    match text.char_indices().nth(chars) {
        None => clean(text),
        Some((end, _)) => format!("{}...", clean(&text[..end])),
    }
}

/// A path, or a part of one, for people: clean.
#[must_use]
pub fn path<P: AsRef<OsStr> + ?Sized>(path: &P) -> String {
    clean(&path.as_ref().to_string_lossy())
}

/// Names one after the other, as many as can be read.
pub fn listed<T: AsRef<str>>(names: impl ExactSizeIterator<Item = T>) -> String {
    let further = names.len().saturating_sub(LISTED);
    let mut told: Vec<String> = names.take(LISTED).map(|name| excerpt(name.as_ref(), NAME_CHARS)).collect();
    if further > 0 {
        told.push(format!("and {further} more"));
    }
    told.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quotations_and_lists_have_an_end() {
        assert_eq!(excerpt("ab\ncd", 3), "ab\\n...");
        assert_eq!(excerpt("日本", 2), "日本");
        let names: Vec<String> = (0..50).map(|number| format!("c{number}")).collect();
        let told = listed(names.iter());
        assert!(told.starts_with("c0, c1, ") && told.ends_with("c19, and 30 more"), "{told}");
        assert_eq!(path("a\nb"), "a\\nb");
    }
}
