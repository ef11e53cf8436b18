//! Notes on what a file leaves out, as its comments.

use crate::text::{line_comment, markup_comment};

/// Notes as comments of XML.
pub(super) fn xml_comments(notes: &[String]) -> String {
    notes.iter().map(|note| format!("{}\n", markup_comment(note))).collect()
}

/// Notes as lines after `mark`.
pub(super) fn line_comments(mark: &str, notes: &[String]) -> String {
    notes.iter().map(|note| line_comment(mark, note)).collect()
}
